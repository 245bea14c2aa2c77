#include "riffler/pen/arms/compensation.hpp"

#include "pen/arms/certain_friction.hpp"
#include "riffler/base/check.hpp"

namespace riffler::pen {

void Compensation::validate() const {
  base::require_between(gravity, 0, 1, "gravity");
  base::require_between(friction, 0, 1, "friction");
}

void CompensationShares::validate() const {
  Compensation{gravity.value_or(0), friction.value_or(0)}.validate();
}

Compensation CompensationShares::of(const PenGeometry& pen) const noexcept {
  const bool identified = pen.uncertainty.has_value();
  return {gravity.value_or(identified ? 1 : 0), friction.value_or(identified ? 0.5 : 0)};
}

MotorTorques compensation_torques(const PenGeometry& pen, const Compensation& share, const JointAngles& angles,
                                  const JointAngles& rates) noexcept {
  const MotorTorques weight = motor_torques(pen, gravity_torques(pen, angles));
  MotorTorques rubs = friction_torques(pen, rates);
  if (pen.uncertainty && share.friction > 0)
    for (std::size_t k = 0; k < kPenChannels; ++k) rubs[k] *= certain_share(pen, k);
  MotorTorques out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) out[k] = share.gravity * weight[k] + share.friction * rubs[k];
  const double scale = scale_to_peaks(pen, out);
  for (double& torque : out) torque *= scale;
  return out;
}

}  // namespace riffler::pen
