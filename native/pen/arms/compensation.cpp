#include "riffler/pen/arms/compensation.hpp"

#include "riffler/base/check.hpp"

namespace riffler::pen {

void Compensation::validate() const {
  base::require_between(gravity, 0, 1, "gravity");
  base::require_between(friction, 0, 1, "friction");
}

MotorTorques compensation_torques(const PenGeometry& pen, const Compensation& share, const JointAngles& angles,
                                  const JointAngles& rates) noexcept {
  const MotorTorques weight = motor_torques(pen, gravity_torques(pen, angles)), rubs = friction_torques(pen, rates);
  MotorTorques out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) out[k] = share.gravity * weight[k] + share.friction * rubs[k];
  const double scale = scale_to_peaks(pen, out);
  for (double& torque : out) torque *= scale;
  return out;
}

}  // namespace riffler::pen
