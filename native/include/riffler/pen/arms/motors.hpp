// From torques at the joints to what the motors are told, and what the arms' weight and friction take of it.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/haptics/limits.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

using MotorTorques = std::array<double, kPenChannels>;  // N·mm at the motors, in the device's order

/// Through the gears: a motor that turns `ratio` times as far needs that much less torque.
MotorTorques motor_torques(const PenGeometry& pen, const JointAngles& joint_torques) noexcept;
/// And back.
JointAngles joint_torques(const PenGeometry& pen, const MotorTorques& motor_torques) noexcept;

/// The largest factor up to 1 with which no motor passes its peak beside what it has already (`first`, within the
/// peaks); 0 where a torque is not finite.
double scale_to_peaks(const PenGeometry& pen, const MotorTorques& torques, const MotorTorques& first = {}) noexcept;

struct MotorCommands {
  std::array<std::int16_t, kPenChannels> values{};
  /// By which all torques were scaled down together so that no motor passes its peak: the wrench keeps its direction. 0
  /// where a torque is not finite; every motor is then told none.
  double scale = 0;
};

/// Of the pen's own reports: mA, positive where the motor turns so that its counter grows. Rounded to the nearest. What
/// the motors do by themselves (`first`, within the peaks) is left alone, and `torques` share what remains.
MotorCommands motor_currents(const PenGeometry& pen, const MotorTorques& torques,
                             const MotorTorques& first = {}) noexcept;
/// Of a converter's board: steps, slope · torque + offset, rounded to the nearest.
MotorCommands converter_steps(const PenGeometry& pen, const Converter& converter, const MotorTorques& torques) noexcept;

/// Joint torques that hold the arms' own weight, base frame upright. The parallelograms keep both links' directions
/// apart, so the weight of all parts gives joint 2 a moment ~ sin θ2 and joint 3 one ~ cos θ3, whatever the masses.
JointAngles gravity_torques(const PenGeometry& pen, const JointAngles& angles) noexcept;

/// Motor torques that make up for friction at these joint speeds (rad/s): dry, which comes in over friction_speed so
/// that noise about standstill is not pushed, and viscous.
MotorTorques friction_torques(const PenGeometry& pen, const JointAngles& rates) noexcept;

}  // namespace riffler::pen
