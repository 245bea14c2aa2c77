// Motor torques in addition to the requested wrench: compensation of the arms' weight and friction.
#pragma once

#include "riffler/pen/arms/motors.hpp"

namespace riffler::pen {

/// Fractions, 0 to 1, of the described values to compensate. Where the real weight or friction is smaller than
/// described, the pen would rise or keep moving; the default therefore compensates nothing, and other values are for
/// measured pens.
struct Compensation {
  double gravity = 0;
  /// As long as the real friction is at least this fraction of the described one, the pen stays dissipative for any
  /// delay: dry friction is compensated by at most its fraction in every direction, and for viscous friction a delayed
  /// compensation does no more work than an instant one (Cauchy–Schwarz).
  double friction = 0;

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Torques (N·mm) at the motors, in the device's order, for joint angles (rad) and rates (rad/s). If a motor would
/// exceed its peak, all torques are scaled down by one factor.
MotorTorques compensation_torques(const PenGeometry& pen, const Compensation& share, const JointAngles& angles,
                                  const JointAngles& rates) noexcept;

}  // namespace riffler::pen
