// From joint torques to motor commands, and the torques of the arms' weight and friction.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/haptics/limits.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

using MotorTorques = std::array<double, kPenChannels>;  // N·mm at the motors, in the device's order

/// Motor torques for joint torques, N·mm. A motor that turns `ratio` times as far needs that much less torque.
MotorTorques motor_torques(const PenGeometry& pen, const JointAngles& joint_torques) noexcept;
/// The inverse of motor_torques.
JointAngles joint_torques(const PenGeometry& pen, const MotorTorques& motor_torques) noexcept;

/// Largest factor up to 1 on `torques` with which no motor exceeds its peak, given the torques `first` that it already
/// bears (within the peaks). 0 if a torque is not finite.
double scale_to_peaks(const PenGeometry& pen, const MotorTorques& torques, const MotorTorques& first = {}) noexcept;

/// Commands for all motors, in the device's order.
struct MotorCommands {
  std::array<std::int16_t, kPenChannels> values{};
  /// Common factor that keeps every motor within its peak; the wrench keeps its direction. 0 if a torque is not finite;
  /// all commands are then zero.
  double scale = 0;
};

/// Commands for the pen's own reports: mA, positive where the motor turns so that its counter grows, rounded to
/// nearest. Compensation torques `first` (within the peaks) are not scaled; `torques` share what remains.
MotorCommands motor_currents(const PenGeometry& pen, const MotorTorques& torques,
                             const MotorTorques& first = {}) noexcept;
/// Commands for a converter board: steps = slope · torque + offset, rounded to nearest.
MotorCommands converter_steps(const PenGeometry& pen, const Converter& converter, const MotorTorques& torques) noexcept;

/// Joint torques (N·mm) that hold the arms' own weight, with the base upright. The parallelograms make the directions
/// of both links independent, so the weight gives joint 2 a moment ~ sin θ2 and joint 3 one ~ cos θ3, for any
/// masses.
JointAngles gravity_torques(const PenGeometry& pen, const JointAngles& angles) noexcept;

/// Motor torques (N·mm) that compensate friction at joint rates in rad/s: dry friction, which sets in over
/// friction_speed so that noise around standstill has no effect, and viscous friction.
MotorTorques friction_torques(const PenGeometry& pen, const JointAngles& rates) noexcept;

}  // namespace riffler::pen
