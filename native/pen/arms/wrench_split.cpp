#include "pen/arms/wrench_split.hpp"

#include <cmath>

namespace riffler::pen {

WrenchSplit split_wrench(const Wrench& wrench, const Vec3& apart) noexcept {
  const double length = glm::length(apart);
  if (!(length > 0)) return {{0.5 * wrench.force, 0.5 * wrench.force}, wrench.torque};
  // Via the unit vector: |r|² of a grip of 1e-160 would be zero.
  const Vec3 along = apart / length;
  const Vec3 couple = glm::cross(wrench.torque, along) / length;
  const Vec3 half = 0.5 * wrench.force;
  return {{half - couple, half + couple}, glm::dot(wrench.torque, along) * along};
}

Wrench wrench_of(const ArmForces& forces, const Vec3& apart) noexcept {
  const Vec3 &right = forces[index(Arm::R)], &left = forces[index(Arm::L)];
  return {right + left, glm::cross(0.5 * apart, left - right)};
}

PenEffort pen_effort(const PenKinematics& pen, const PenPosture& posture, const Wrench& wrench,
                     const Vec3& at) noexcept {
  const Wrench here = moved(wrench, at, posture.pose.tip);
  const WrenchSplit split = split_wrench({pen.to_base(here.force), pen.to_base(here.torque)}, posture.apart);
  PenEffort out;
  for (std::size_t arm = 0; arm < 2; ++arm) out.torques[arm] = joint_torques(posture.arms[arm], split.forces[arm]);
  out.missing = pen.from_base(split.missing);
  return out;
}

Wrench felt_wrench(const PenKinematics& pen, const PenPosture& posture, const JointAngles& torques) noexcept {
  constexpr double kSingular = 1e-3;  // limit of arm_dexterity
  ArmForces forces{Vec3(0), Vec3(0)};
  for (std::size_t arm = 0; arm < 2; ++arm)
    if (std::abs(arm_dexterity(pen.geometry().arms[arm], posture.angles[arm])) > kSingular)
      forces[arm] = torques[arm] * glm::inverse(posture.arms[arm].jacobian);
  const Wrench in_base = wrench_of(forces, posture.apart);
  return {pen.from_base(in_base.force), pen.from_base(in_base.torque)};
}

}  // namespace riffler::pen
