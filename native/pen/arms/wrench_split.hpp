// What the two arms push with so that the hand feels a force and a torque (4.14–4.18).
#pragma once

#include <array>

#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/arms/kinematics.hpp"

namespace riffler::pen {

using ArmForces = std::array<Vec3, 2>;  // R, L; N

struct WrenchSplit {
  ArmForces forces{};
  Vec3 missing{0};  // the torque that cannot be felt: its part along the grip
};

/// `wrench` is about the grip's pivot (the middle between the arms' ends), `apart` = r_L − r_R, in one frame. Each arm
/// has half the force, and a couple (τ × r)/|r|² on the left, its opposite on the right, whose torque r × (τ × r)/|r|²
/// is exactly the part of τ square to the grip. The source's (4.16) overstates it by |τ| over that part, and divides by
/// zero where τ lies along r. Of all forces with this wrench these are the least: they do not squeeze the grip. Ends
/// that coincide can bear no couple, so all of τ is missing then.
WrenchSplit split_wrench(const Wrench& wrench, const Vec3& apart) noexcept;

/// The wrench about the pivot that the hand feels of the arms' forces.
Wrench wrench_of(const ArmForces& forces, const Vec3& apart) noexcept;

struct PenEffort {
  JointAngles torques{};  // N·mm at the joints: θ1 θ2 θ3 of R, of L
  Vec3 missing{0};        // torque, frame of poses
};

/// The joint torques with which the arms push so that the hand feels `wrench` about `at`, both in the frame of poses.
PenEffort pen_effort(const PenKinematics& pen, const PenPosture& posture, const Wrench& wrench,
                     const Vec3& at) noexcept;

/// And back: the wrench about the grip's pivot, frame of poses, that the hand feels of joint torques. An arm that is
/// singular, and could bear any force, counts as bearing none.
Wrench felt_wrench(const PenKinematics& pen, const PenPosture& posture, const JointAngles& torques) noexcept;

}  // namespace riffler::pen
