#include "pen/simulated/simulated_weight.hpp"

#include <algorithm>

#include "riffler/base/check.hpp"

namespace riffler::pen {

namespace {

constexpr double kThread = 60;                  // mm
constexpr double kStiffness = 2, kDrag = 0.01;  // of the thread: N/mm, N·s/mm along it
constexpr double kAir = 0.5;                    // 1/s: decay of the swing
constexpr double kMilli = 1e-3;                 // kg to N·s²/mm
constexpr double kHeaviest = 2;                 // kg

}  // namespace

void SimulatedWeight::hang(double mass, double hook) {
  if (mass == mass_ && hook == hook_) return;
  base::require_between(mass, 0, kHeaviest, "mass");
  base::require_finite(hook, "hook");
  mass_ = mass, hook_ = hook, hangs_ = false;
}

Wrench SimulatedWeight::pull(const PenKinematics& pen, const PenPosture& posture, const PenSpeed& speed, double dt) {
  if (mass_ == 0) return {};
  const Vec3 down = pen.from_base(Vec3(0, 0, -1)), arm = -hook_ * posture.pose.axis;
  const Vec3 point = posture.pose.tip + arm, moves = speed.twist.linear + glm::cross(speed.twist.angular, arm);
  const double mass = kMilli * mass_, fall = 1e3 * kStandardGravity;
  if (!hangs_) place_ = point + (kThread + mass * fall / kStiffness) * down, speed_ = moves, hangs_ = true;
  const Vec3 thread = place_ - point;
  const double length = glm::length(thread);
  if (length == 0) return {};
  const Vec3 along = thread / length;
  const double tension =
      std::max(0.0, length > kThread ? kStiffness * (length - kThread) + kDrag * glm::dot(speed_ - moves, along) : 0.0);
  speed_ += dt * (fall * down - tension / mass * along - kAir * (speed_ - moves));
  place_ += dt * speed_;
  const Vec3 force = tension * along;
  return {force, glm::cross(arm, force)};
}

}  // namespace riffler::pen
