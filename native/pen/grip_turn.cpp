#include "pen/grip_turn.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"

namespace riffler::pen {

UnitQuaternion quaternion_of(const Mat3& m) {
  // The largest part first: it is at least 1/2.
  const double squares[4] = {1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2],
                             1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2]};
  const auto largest = std::max_element(squares, squares + 4) - squares;
  const double part = 0.5 * std::sqrt(squares[largest]), quarter = 0.25 / part;
  const Vec3 odd = quarter * Vec3(m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]);
  const double xy = quarter * (m[0][1] + m[1][0]), xz = quarter * (m[0][2] + m[2][0]),
               yz = quarter * (m[1][2] + m[2][1]);
  if (largest == 0) return {part, odd};
  if (largest == 1) return {odd.x, {part, xy, xz}};
  if (largest == 2) return {odd.y, {xy, part, yz}};
  return {odd.z, {xz, yz, part}};
}

Vec3 rotated(const UnitQuaternion& q, const Vec3& v) {
  const Vec3 t = 2.0 * glm::cross(q.v, v);
  return v + q.w * t + glm::cross(q.v, t);
}

void GripTurn::turn(const UnitQuaternion& q, double now, PenSample& sample) noexcept {
  const Vec3 axis = glm::normalize(rotated(q, own_)), before = sample.pose.axis;
  const double along = glm::dot(q.v, own_);
  const double twist = geom::hypot(q.w, along) > 1e-6 ? 2 * base::atan2(along, q.w) : twist_;
  const double dt = now - time_;
  if (!turned_) {
    sample.spin = std::remainder(twist, kTwoPi);
    sample.turning = Vec3(0);
  } else {
    const double rolled = std::remainder(twist - twist_, kTwoPi);
    sample.spin += rolled;
    if (dt > 0) {
      const Vec3 cross = glm::cross(before, axis);
      const double sine = glm::length(cross), angle = base::atan2(sine, glm::dot(before, axis));
      const Vec3 rate = ((sine > 0 ? angle / sine : 0) * cross + rolled * axis) / dt;
      sample.turning += dt / (dt + smooth_) * (rate - sample.turning);
    }
  }
  sample.pose.axis = axis;
  twist_ = twist;
  time_ = now;
  turned_ = true;
}

}  // namespace riffler::pen
