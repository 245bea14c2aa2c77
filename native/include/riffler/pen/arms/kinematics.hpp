// Kinematics of the pen: from encoder counts to its pose and back (2.1–2.11). The functions of a haptic step neither
// allocate nor throw.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/arms/arm.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

using EncoderCounts = std::array<std::int32_t, kPenChannels>;  // in the device's order
using JointAngles = std::array<Vec3, 2>;                       // θ1 θ2 θ3 of R and of L; rad, or rad/s for rates

/// The angle in (−π, π] that equals `angle` up to whole turns.
double within_a_turn(double angle) noexcept;

/// The posture of the pen at given joint angles.
struct PenPosture {
  JointAngles angles{};
  std::array<ArmPosture, 2> arms{};  // base frame
  Vec3 apart{0};                     // r_L − r_R, base frame, mm
  double length = 0;                 // mm, of `apart`: equals the grip's length if every count is right
  /// In the pose frame: tip is the grip's pivot r_G (2.3); axis is the unit vector ±s_G (2.4) along the grip, away from
  /// the end nearer to the tool's tip. Zero axis if the arms' ends coincide, which a rigid grip prevents.
  Pose pose{};
};

/// The grip's motion at given joint rates.
struct PenSpeed {
  Twist twist{};  // of the grip about its pivot, pose frame; rotation about its own axis is not measured by the arms
  double stretch = 0;  // mm/s: rate of the grip's length; 0 for a rigid grip
};

/// Joint angles for a pose, and whether both arms reach it.
struct PenInverse {
  JointAngles angles{};
  std::array<ReachResult, 2> reach{ReachResult::NotFinite, ReachResult::NotFinite};  // R, L
  bool reached() const { return reach[0] == ReachResult::Reached && reach[1] == ReachResult::Reached; }
};

/// Forward and inverse kinematics of a pen, with the homing of its counters.
class PenKinematics {
 public:
  explicit PenKinematics(const PenGeometry& geometry);

  const PenGeometry& geometry() const noexcept { return geometry_; }

  /// Sets the home posture: the counters read `raw` and `probe` there. The counters may start anywhere and may wrap.
  /// Before the first call they are taken as preset.
  void home_at(const EncoderCounts& raw, std::int32_t probe) noexcept;

  /// What the counters would read if homing had preset them. Counts wrap.
  EncoderCounts preset(const EncoderCounts& raw) const noexcept;
  /// Joint angles of raw counts (2.9).
  JointAngles angles(const EncoderCounts& raw) const noexcept;
  /// The nearest raw counts for joint angles; inverse of angles(). Counts wrap.
  EncoderCounts counts(const JointAngles& angles) const noexcept;
  /// Joint angles of the home posture.
  JointAngles home_angles() const noexcept;
  /// Rotation of the grip about its own axis (right-handed about the pose's axis) in rad, 0 at the preset 0. Whole
  /// turns accumulate.
  double probe_angle(std::int32_t raw) const noexcept;
  /// The nearest count for a rotation of the grip (rad).
  std::int32_t probe_count(double angle) const noexcept;

  /// The posture at joint angles (rad), or at raw counts.
  PenPosture posture(const JointAngles& angles) const noexcept;
  PenPosture posture(const EncoderCounts& raw) const noexcept { return posture(angles(raw)); }
  /// The grip's motion in a posture at joint rates (rad/s).
  PenSpeed speed(const PenPosture& posture, const JointAngles& rates) const noexcept;

  /// Joint angles that bring the grip's middle and direction to `pose` (pose frame, unit axis), or which arm cannot
  /// reach it and why. Checks the limits of joints and elbows.
  PenInverse inverse(const Pose& pose) const noexcept;

  /// Transforms vectors between base frame and pose frame.
  Vec3 to_base(const Vec3& v) const noexcept { return v * geometry_.turn; }
  Vec3 from_base(const Vec3& v) const noexcept { return geometry_.turn * v; }

 private:
  bool within_limits(Arm arm, const Vec3& angles) const noexcept;

  PenGeometry geometry_;
  EncoderCounts at_home_{};
  std::int32_t probe_at_home_ = 0;
  double towards_ = 1;  // sign from s_G to the pose's axis
};

}  // namespace riffler::pen
