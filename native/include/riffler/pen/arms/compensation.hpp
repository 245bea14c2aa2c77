// Motor torques in addition to the requested wrench: compensation of the arms' weight and friction.
#pragma once

#include <optional>

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

/// Shares as a user gives them: those that are not given follow from what is known of the pen.
struct CompensationShares {
  std::optional<double> gravity{}, friction{};

  CompensationShares() = default;
  CompensationShares(std::optional<double> of_gravity, std::optional<double> of_friction)
      : gravity(of_gravity), friction(of_friction) {}
  CompensationShares(const Compensation& given) : gravity(given.gravity), friction(given.friction) {}

  /// Throws std::invalid_argument naming the field.
  void validate() const;
  /// Where nothing is given: all of the weight and half of the friction of a pen that was identified, nothing of one
  /// that was not.
  Compensation of(const PenGeometry& pen) const noexcept;
};

/// Torques (N·mm) at the motors, in the device's order, for joint angles (rad) and rates (rad/s). If a motor would
/// exceed its peak, all torques are scaled down by one factor. For an identified pen, the share of friction is
/// one of the part that is certainly there (certain_friction).
MotorTorques compensation_torques(const PenGeometry& pen, const Compensation& share, const JointAngles& angles,
                                  const JointAngles& rates) noexcept;

}  // namespace riffler::pen
