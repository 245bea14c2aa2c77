// One arm of the pen: where its end is, how it moves there, and which angles bring it to a point.
//
// θ1 turns the arm about the upright axis through its shoulder. In the arm's plane a parallelogram turns the upper arm
// by θ2 from hanging straight down, and the fore arm by θ3 from level, whatever θ2 is (fig. 2.6).
#pragma once

#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

struct ArmPosture {
  Vec3 end{0};       // base frame, mm
  Mat3 jacobian{1};  // mm per rad: column j is what joint j moves the end by
};

/// (2.1), (2.2) and their derivatives (2.7), (2.8); row 2, column 3 is −L2 S1 S3, where the source prints −L2 S2 S3.
/// Finite for any finite angles. Allocates nothing.
ArmPosture arm_posture(const ArmLinks& links, const Vec3& angles) noexcept;

/// Joint torques (N·mm) that hold against −force at the end, (2.5), (2.6): Jᵀ f.
inline Vec3 joint_torques(const ArmPosture& posture, const Vec3& force) noexcept {
  return force * posture.jacobian;
}

/// How well the arm can move in all directions, −1 to 1: cos(θ2 − θ3) times the end's distance from the upright axis in
/// lengths of the straight arm. 0 where it is singular: arm straight or folded, or its end on the upright axis. This is
/// det J / (L1 L2 (L1 + L2)) but for the sign of the joints' order.
double arm_dexterity(const ArmLinks& links, const Vec3& angles) noexcept;

enum class ReachResult : unsigned char {
  Reached,
  TooFar,     // beyond the straight arm
  TooNear,    // nearer to the shoulder than the folded arm
  OnAxis,     // on the upright axis, or a folded arm's shoulder: θ1 or θ3 could be anything
  NotFinite,  // NaN or infinity was asked for
  Limits,     // the angles are there, and beyond the joints' limits
};

struct ArmInverse {
  Vec3 angles{0};  // of the nearest reach where there is none
  ReachResult reach = ReachResult::NotFinite;
};

/// The angles at which the end is at `end`, with the fore arm on the hand's side of the upper arm, as at home:
/// |θ2 − θ3| ≤ π/2. A point beyond the reach gives the angles of the straight or folded arm towards it.
ArmInverse arm_angles(const ArmLinks& links, const Vec3& end) noexcept;

}  // namespace riffler::pen
