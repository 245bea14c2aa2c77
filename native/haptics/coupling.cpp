#include "riffler/haptics/coupling.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "riffler/haptics/settings.hpp"

namespace riffler::haptics {

namespace {

/// A unit vector orthogonal to `a`, built from the coordinate axis farthest from it. More accurate than
/// any_perpendicular(), with different bits.
Vec3 any_square_to(const Vec3& a) {
  const Vec3 m = glm::abs(a);
  const Vec3 far = m.x <= m.y && m.x <= m.z ? Vec3(1, 0, 0) : m.y <= m.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  return glm::normalize(glm::cross(a, far));
}

/// Smallest rotation from unit vector to unit vector. Uses the difference, or near half a turn the sum, which stays
/// exact where the cross product of the vectors themselves would be rounding noise.
Vec3 turn(const Vec3& from, const Vec3& to) {
  const double along = glm::dot(from, to);
  const Vec3 c = glm::cross(from, along > 0 ? to - from : to + from);
  const double s = glm::length(c);
  if (along > 0) return s > 0 ? base::atan2(s, along) / s * c : Vec3(0);
  return s > 1e-15 ? base::atan2(s, along) / s * c : kPi * any_square_to(from);
}

/// Rotation vector of a rotation matrix, via its quaternion, computed from its largest component (Shepperd 1978).
Vec3 rotation_vector(const Mat3& r) {
  const double squares[4] = {1 + r[0][0] + r[1][1] + r[2][2], 1 + r[0][0] - r[1][1] - r[2][2],
                             1 - r[0][0] + r[1][1] - r[2][2], 1 - r[0][0] - r[1][1] + r[2][2]};
  const auto largest = std::max_element(squares, squares + 4) - squares;
  const Vec3 odd(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
  double w = squares[0];
  Vec3 v = odd;
  if (largest > 0) {
    const int i = static_cast<int>(largest) - 1, j = (i + 1) % 3, k = (i + 2) % 3;
    w = odd[i];
    v[i] = squares[largest], v[j] = r[i][j] + r[j][i], v[k] = r[i][k] + r[k][i];
  }
  if (w < 0) w = -w, v = -v;
  const double s = glm::length(v);
  return s > 0 ? 2 * base::atan2(s, w) / s * v : Vec3(0);
}

/// Spring force over stiffness, and energy over stiffness, at a stretch `x` ≤ `end`. Grows up to `limit`, then stays
/// constant and, if `end` is finite, falls over the last `limit`.
struct Law {
  double force, energy;
};
Law spring(double x, double limit, double end) {
  const double fall = std::max(0.0, x - (end - limit)), flat = std::max(0.0, x - limit), rise = std::min(x, limit);
  return {rise - fall, 0.5 * (rise * rise - fall * fall) + limit * flat};
}

Vec3 along(const Vec3& v, double length, double x) {
  return length > 0 ? x / length * v : Vec3(0);
}

}  // namespace

void CouplingSettings::validate() const {
  base::require_not_negative(stiffness, "stiffness");
  base::require_not_negative(damping, "damping");
  base::require_not_negative(turn_stiffness, "turn_stiffness");
  base::require_not_negative(turn_damping, "turn_damping");
  base::require_positive(max_stretch, "max_stretch");
  base::require_positive(max_turn, "max_turn");
  base::require_between(max_turn, 0, kPi / 2, "max_turn");
}

CouplingSettings CouplingSettings::at_tool(double scale) const {
  CouplingSettings out = *this;
  out.stiffness /= scale * scale, out.damping /= scale * scale;
  out.max_stretch *= scale;
  return out;
}

double CouplingSettings::capacity(double longest) const {
  return stiffness * spring(longest, max_stretch, std::numeric_limits<double>::infinity()).energy +
         turn_stiffness * spring(kPi, max_turn, kPi).energy;
}

PoseError pose_error(const Pose& device, const Pose& tool) {
  return {device.tip - tool.tip, turn(tool.axis, device.axis)};
}

PoseError pose_error(const RigidFrame& device, const RigidFrame& tool) {
  return {device.point - tool.point, rotation_vector(device.axes * glm::transpose(tool.axes))};
}

CouplingWrenches couple(const CouplingSettings& settings, const PoseError& stretch, const Twist& device,
                        const Twist& tool) {
  const double length = glm::length(stretch.translation), angle = std::min(glm::length(stretch.rotation), kPi);
  const Law pull = spring(length, settings.max_stretch, std::numeric_limits<double>::infinity());
  const Law turn = spring(angle, settings.max_turn, kPi);
  const Twist relative = device - tool;
  // On the tool, towards the device. The force has no moment about the device's point, since its line passes through
  // it.
  const Wrench on_tool{
      along(stretch.translation, length, settings.stiffness * pull.force) + settings.damping * relative.linear,
      along(stretch.rotation, angle, settings.turn_stiffness * turn.force) + settings.turn_damping * relative.angular};
  return {-on_tool, on_tool, settings.stiffness * pull.energy + settings.turn_stiffness * turn.energy};
}

}  // namespace riffler::haptics
