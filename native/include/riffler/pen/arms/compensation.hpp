// What the motors do by themselves, besides the wrench that was asked for: they bear the arms' weight, and make up for
// their friction.
#pragma once

#include "riffler/pen/arms/motors.hpp"

namespace riffler::pen {

/// Shares, 0 to 1, of what the pen's description says. Weights and friction that are less than described make a pen
/// that rises, or that moves on by itself: the default does nothing, and a share is for pens that somebody has
/// measured.
struct Compensation {
  double gravity = 0;
  /// Below the share by which real friction may be less than the described, it takes energy from the hand as before,
  /// however late it comes: dry friction is made up for by no more than its share of it in any direction, and of the
  /// viscous one a late answer is worth no more than an instant one (Cauchy and Schwarz).
  double friction = 0;

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// N·mm at the motors, in the device's order, for these joint angles (rad) and rates (rad/s); where that is beyond a
/// motor's peak, all of it is less by one factor.
MotorTorques compensation_torques(const PenGeometry& pen, const Compensation& share, const JointAngles& angles,
                                  const JointAngles& rates) noexcept;

}  // namespace riffler::pen
