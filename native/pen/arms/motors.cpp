#include "riffler/pen/arms/motors.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "pen/arms/wrench_split.hpp"

namespace riffler::pen {

namespace {

bool all_finite(const MotorTorques& torques) {
  return std::all_of(torques.begin(), torques.end(), [](double t) { return std::isfinite(t); });
}

std::int16_t rounded(double value, double lowest, double highest) {
  return static_cast<std::int16_t>(std::clamp(std::nearbyint(value), lowest, highest));
}

}  // namespace

MotorTorques motor_torques(const PenGeometry& pen, const JointAngles& joint_torques) noexcept {
  MotorTorques out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = pen.channels[k];
    out[k] = c.sign * joint_torques[index(c.arm)][c.joint] / c.ratio;
  }
  return out;
}

double scale_to_peaks(const PenGeometry& pen, const MotorTorques& torques, const MotorTorques& first) noexcept {
  double scale = 1;
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const double size = std::abs(torques[k]);
    if (!std::isfinite(size)) return 0;
    const double left = pen.channels[k].peak_torque() - (torques[k] < 0 ? -first[k] : first[k]);
    if (size > left) scale = std::min(scale, std::max(left, 0.0) / size);
  }
  return scale;
}

JointAngles joint_torques(const PenGeometry& pen, const MotorTorques& motor_torques) noexcept {
  JointAngles out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = pen.channels[k];
    out[index(c.arm)][c.joint] = c.sign * motor_torques[k] * c.ratio;
  }
  return out;
}

MotorCommands motor_currents(const PenGeometry& pen, const MotorTorques& torques, const MotorTorques& first) noexcept {
  MotorCommands out;
  if (!all_finite(torques) || !all_finite(first)) return out;
  out.scale = scale_to_peaks(pen, torques, first);
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = pen.channels[k];
    // Rounded down, so as not to exceed the peak.
    const double most = std::floor(1000 * c.peak_current);
    out.values[k] = rounded(1000 * (first[k] + out.scale * torques[k]) / c.torque_constant, -most, most);
  }
  return out;
}

MotorCommands converter_steps(const PenGeometry& pen, const Converter& converter,
                              const MotorTorques& torques) noexcept {
  MotorCommands out;
  out.scale = scale_to_peaks(pen, torques);
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const double torque = out.scale == 0 ? 0 : out.scale * torques[k];
    out.values[k] = rounded(converter.slope[k] * torque + converter.offset[k], converter.lowest(), converter.highest());
  }
  return out;
}

JointAngles gravity_torques(const PenGeometry& pen, const JointAngles& angles) noexcept {
  JointAngles out{};
  for (const PenChannel& c : pen.channels) {
    const double angle = angles[index(c.arm)][c.joint];
    // Joint 1 turns about the vertical: no weight.
    out[index(c.arm)][c.joint] = c.joint == 0 ? 0 : c.gravity * (c.joint == 1 ? base::sin(angle) : base::cos(angle));
  }
  return out;
}

MotorTorques friction_torques(const PenGeometry& pen, const JointAngles& rates) noexcept {
  MotorTorques out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = pen.channels[k];
    const double rate = c.sign * rates[index(c.arm)][c.joint] * c.ratio;
    out[k] = c.coulomb * base::tanh(rate / pen.friction_speed) + c.viscous * rate;
  }
  return out;
}

}  // namespace riffler::pen
