// From the pen's counters to its pose and back (2.1–2.11). What a haptic step calls allocates nothing and throws
// nothing.
#pragma once

#include <array>
#include <cstdint>

#include "riffler/geom/pose.hpp"
#include "riffler/haptics/wrench.hpp"
#include "riffler/pen/arms/arm.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

using EncoderCounts = std::array<std::int32_t, kPenChannels>;  // in the device's order
using JointAngles = std::array<Vec3, 2>;                       // θ1 θ2 θ3 of R, of L; rad, or rad/s of speeds

/// The least angle in (−π, π] that is `angle` but for whole turns.
double within_a_turn(double angle) noexcept;

struct PenPosture {
  JointAngles angles{};
  std::array<ArmPosture, 2> arms{};  // base frame
  Vec3 apart{0};                     // r_L − r_R, base frame, mm
  double length = 0;                 // of `apart`: the grip's, if every count is right
  /// In the frame of poses: tip is the grip's pivot r_G (2.3), axis the unit vector ±s_G (2.4) along the grip, away
  /// from the end that is nearer the tool's tip. A zero axis where the arms' ends coincide, which a rigid grip
  /// prevents.
  Pose pose{};
};

struct PenSpeed {
  Twist twist{};       // of the grip about its pivot, frame of poses; the arms cannot see it turn about itself
  double stretch = 0;  // mm/s: by which the grip would grow; a rigid one's is 0
};

struct PenInverse {
  JointAngles angles{};
  std::array<ReachResult, 2> reach{ReachResult::NotFinite, ReachResult::NotFinite};  // R, L
  bool reached() const { return reach[0] == ReachResult::Reached && reach[1] == ReachResult::Reached; }
};

class PenKinematics {
 public:
  explicit PenKinematics(const PenGeometry& geometry);

  const PenGeometry& geometry() const noexcept { return geometry_; }

  /// From here on the counters that read `raw` and `probe` stand for the home posture, as if they had been preset: any
  /// start of the device's counters is as good as another, and they may wrap. Until then they are taken to be preset.
  void home_at(const EncoderCounts& raw, std::int32_t probe) noexcept;

  /// What the counters would read had homing preset them; they wrap.
  EncoderCounts preset(const EncoderCounts& raw) const noexcept;
  /// (2.9) of counters as they are read.
  JointAngles angles(const EncoderCounts& raw) const noexcept;
  /// The nearest counts, counters taken as angles() takes them; they wrap.
  EncoderCounts counts(const JointAngles& angles) const noexcept;
  /// The presets' angles.
  JointAngles home_angles() const noexcept;
  /// The grip's rotation about its axis (right-handed about the pose's axis), rad, 0 at the preset 0; turns add up.
  double probe_angle(std::int32_t raw) const noexcept;
  /// The nearest count.
  std::int32_t probe_count(double angle) const noexcept;

  PenPosture posture(const JointAngles& angles) const noexcept;
  PenPosture posture(const EncoderCounts& raw) const noexcept { return posture(angles(raw)); }
  PenSpeed speed(const PenPosture& posture, const JointAngles& rates) const noexcept;

  /// The angles that bring the grip's middle and direction to those of `pose` (frame of poses, unit axis), and which
  /// arm cannot and why. Limits of the joints and of the elbow count.
  PenInverse inverse(const Pose& pose) const noexcept;

  /// Base frame ↔ frame of poses, of vectors.
  Vec3 to_base(const Vec3& v) const noexcept { return v * geometry_.turn; }
  Vec3 from_base(const Vec3& v) const noexcept { return geometry_.turn * v; }

 private:
  bool within_limits(Arm arm, const Vec3& angles) const noexcept;

  PenGeometry geometry_;
  EncoderCounts at_home_{};
  std::int32_t probe_at_home_ = 0;
  double towards_ = 1;  // from s_G to the pose's axis
};

}  // namespace riffler::pen
