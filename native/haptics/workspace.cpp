#include "riffler/haptics/workspace.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "riffler/haptics/coupling.hpp"
#include "riffler/haptics/settings.hpp"

namespace riffler::haptics {

namespace {

constexpr double kFarthestPivot = 1000;  // mm

/// Rotation matrix of a rotation vector (Rodrigues).
Mat3 rotation(const Vec3& turn) {
  const double angle = glm::length(turn);
  if (angle == 0) return Mat3(1);
  const Vec3 n = turn / angle;
  const Mat3 cross(Vec3(0, n.z, -n.y), Vec3(-n.z, 0, n.x), Vec3(n.y, -n.x, 0));
  return Mat3(1) + base::sin(angle) * cross + (1 - base::cos(angle)) * cross * cross;
}

}  // namespace

void WorkspaceSettings::validate() const {
  base::require_positive(scale, "scale");
  if (!(std::abs(pivot) <= kFarthestPivot))
    throw std::invalid_argument("pivot must be at most " + std::to_string(static_cast<int>(kFarthestPivot)) + " mm");
  const Mat3 square = glm::transpose(turn) * turn - Mat3(1);
  double off = 0;
  for (int i = 0; i < 3; ++i) off += glm::length(square[i]);
  if (!(off < 1e-9) || glm::determinant(turn) < 0)
    throw std::invalid_argument("turn must be orthonormal and right-handed");
  if ((clutch_mask & dead_man_mask) != 0)
    throw std::invalid_argument("clutch_mask must share no button with dead_man_mask");
}

Workspace::Workspace(const WorkspaceSettings& settings) : settings_(settings) {
  settings.validate();
}

void Workspace::place(const Pose& target) {
  target_ = target, begun_ = false;
}

void Workspace::set(const WorkspaceSettings& settings) {
  settings.validate();
  settings_ = settings;
  pair_here();
}

void Workspace::pair_here() {
  grip_pair_ = grip_, target_pair_ = target_;
  // The smallest additional rotation on top of the existing one: earlier rotations are kept.
  const Vec3 shown = glm::normalize(aslant_ * (settings_.turn * grip_.axis));
  aslant_ = rotation(pose_error(Pose{Vec3(0), target_.axis}, Pose{Vec3(0), shown}).rotation) * aslant_;
  // Re-orthonormalise, so that rounding does not accumulate.
  aslant_[0] = glm::normalize(aslant_[0]);
  aslant_[1] = glm::normalize(aslant_[1] - glm::dot(aslant_[0], aslant_[1]) * aslant_[0]);
  aslant_[2] = glm::cross(aslant_[0], aslant_[1]);
}

Pose Workspace::target(const Pose& grip, std::uint32_t buttons) {
  if (!geom::finite(grip.tip) || !(std::abs(glm::length(grip.axis) - 1) < 1e-6)) return target_;
  const bool clutch = (buttons & settings_.clutch_mask) != 0;
  grip_ = grip;
  // While the clutch is pressed, update the pair; the tick of the release still belongs to it.
  if (!begun_ || clutch || clutched_) pair_here();
  begun_ = true, clutched_ = clutch;
  const Vec3 pivot = target_pair_.tip + settings_.pivot * target_pair_.axis +
                     settings_.scale * (settings_.turn * (grip.tip - grip_pair_.tip));
  target_.axis = glm::normalize(aslant_ * (settings_.turn * grip.axis));
  target_.tip = pivot - settings_.pivot * target_.axis;
  return target_;
}

Twist Workspace::to_target(const Twist& grip) const {
  if (clutched_) return {};
  const Vec3 angular = aslant_ * (settings_.turn * grip.angular);
  // From the pivot to the tip, which the axis carries round it.
  return {settings_.scale * (settings_.turn * grip.linear) - settings_.pivot * glm::cross(angular, target_.axis),
          angular};
}

Wrench Workspace::to_grip(const Wrench& w) const {
  if (clutched_) return {};
  const Mat3 back = glm::transpose(settings_.turn);
  // The transpose of to_target, so that hand and tool exchange the same power.
  const Vec3 torque = w.torque - settings_.pivot * glm::cross(target_.axis, w.force);
  return {settings_.scale * (back * w.force), back * (glm::transpose(aslant_) * torque)};
}

}  // namespace riffler::haptics
