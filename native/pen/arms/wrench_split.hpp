// Splits a wrench on the hand into forces of the two arms (4.14–4.18).
#pragma once

#include <array>

#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

using ArmForces = std::array<Vec3, 2>;  // R, L; N

struct WrenchSplit {
  ArmForces forces{};
  Vec3 missing{0};  // N·mm: torque that cannot be rendered, its component along the grip
};

/// `wrench`: about the grip's pivot (the middle between the arms' ends); `apart` = r_L − r_R, mm, in the same frame.
/// Each arm takes half the force, and the left one the couple force (τ × r)/|r|², the right one its opposite. Their
/// torque r × (τ × r)/|r|² is exactly the component of τ perpendicular to the grip. Erratum: (4.16) of the source is
/// too large by the ratio of |τ| to that component, and divides by zero if τ is along r. These are the smallest forces
/// with this wrench: they do not squeeze the grip. Coinciding ends can bear no couple, so all of τ is missing.
WrenchSplit split_wrench(const Wrench& wrench, const Vec3& apart) noexcept;

/// The wrench about the pivot that the hand feels from the arms' forces.
Wrench wrench_of(const ArmForces& forces, const Vec3& apart) noexcept;

struct PenEffort {
  JointAngles torques{};  // N·mm at the joints: θ1 θ2 θ3 of R and of L
  Vec3 missing{0};        // N·mm: missing torque, pose frame
};

/// Joint torques that make the hand feel `wrench` about `at`, both in the pose frame.
PenEffort pen_effort(const PenKinematics& pen, const PenPosture& posture, const Wrench& wrench,
                     const Vec3& at) noexcept;

/// The inverse: the wrench about the grip's pivot (pose frame) that the hand feels from joint torques. A singular arm,
/// which could bear any force, counts as bearing none.
Wrench felt_wrench(const PenKinematics& pen, const PenPosture& posture, const JointAngles& torques) noexcept;

}  // namespace riffler::pen
