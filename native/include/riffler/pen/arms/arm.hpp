// One arm of the pen: position and Jacobian of its end, and inverse kinematics.
//
// θ1 turns the arm about the vertical axis through its shoulder. In the arm's plane, a parallelogram turns the upper
// arm by θ2 from hanging straight down and the fore arm by θ3 from horizontal, independently of θ2 (fig. 2.6).
#pragma once

#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// Position and Jacobian of an arm's end.
struct ArmPosture {
  Vec3 end{0};       // base frame, mm
  Mat3 jacobian{1};  // mm per rad: column j is the motion of the end per joint j
};

/// Forward kinematics (2.1), (2.2) and its derivatives (2.7), (2.8) at joint angles θ1, θ2, θ3 (rad). Erratum: row 2,
/// column 3 is −L2 S1 S3; the source prints −L2 S2 S3. Finite for all finite angles. Allocates nothing.
ArmPosture arm_posture(const ArmLinks& links, const Vec3& angles) noexcept;

/// Joint torques (N·mm) for the force `force` (N) at the end, (2.5), (2.6): Jᵀ f.
inline Vec3 joint_torques(const ArmPosture& posture, const Vec3& force) noexcept {
  return force * posture.jacobian;
}

/// How well the arm can move in all directions, −1 to 1: cos(θ2 − θ3) times the distance of the end from the vertical
/// axis, relative to the straight arm. 0 in a singular posture: arm straight or folded, or end on the vertical axis.
/// Equals det J / (L1 L2 (L1 + L2)) up to the sign of the joint order.
double arm_dexterity(const ArmLinks& links, const Vec3& angles) noexcept;

/// The result of inverse kinematics for one arm.
enum class ReachResult : unsigned char {
  Reached,
  TooFar,     // further away than the straight arm
  TooNear,    // closer to the shoulder than the folded arm
  OnAxis,     // on the vertical axis, or at the shoulder of a folded arm: θ1 or θ3 is arbitrary
  NotFinite,  // the target is NaN or infinite
  Limits,     // a solution exists but exceeds the joint limits
};

/// Joint angles for a point, and whether the arm reaches it.
struct ArmInverse {
  Vec3 angles{0};  // rad; of the nearest reachable point if `end` is out of reach
  ReachResult reach = ReachResult::NotFinite;
};

/// Joint angles (rad) that bring the end to `end` (base frame, mm), with the fore arm on the hand's side of the upper
/// arm as in the home posture: |θ2 − θ3| ≤ π/2. A point out of reach gives the straight or folded arm towards it.
ArmInverse arm_angles(const ArmLinks& links, const Vec3& end) noexcept;

}  // namespace riffler::pen
