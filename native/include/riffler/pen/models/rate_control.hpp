// From how far a puck is pushed and turned to where the tool goes: speeds that are integrated to a pose.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"

namespace riffler::pen {

struct RateSettings {
  double bubble = 0.08;           ///< share of the full deflection, of all three directions together, that is rest
  double exponent = 2;            ///< of the curve from the bubble's edge to full deflection: 1 is a straight line
  double speed = 60;              ///< mm/s at full deflection
  double turn_rate = 1.5;         ///< rad/s at full deflection
  bool hold_orientation = false;  ///< turning is left out: the tool keeps its axis
  bool hold_position = false;     ///< and moving
  std::array<int, 6> signs{1, 1, 1, 1, 1, 1};  ///< −1, 0 or 1 for x y z a b c, before anything else

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// `deflection`: shares of full, each −1 … 1. The bubble is a ball and the curve acts on the length, so that the
/// direction stays: three bubbles, one on each axis, would bend slow motions towards the axes. Continuous, and zero in
/// the bubble. NaN is rest.
Vec3 shaped(const Vec3& deflection, double bubble, double exponent) noexcept;

class RateControl {
 public:
  /// Validates.
  explicit RateControl(const RateSettings& settings = {});

  /// Where the tool goes on from.
  void place(const Pose& pose) noexcept { pose_ = pose; }
  /// Translation and rotation as shares of full deflection, from `now` on.
  void push(const Vec3& translation, const Vec3& rotation) noexcept;
  /// Integrates up to `now`; steps longer than 0.1 s (a suspended machine) count as 0.1 s.
  void advance(double now) noexcept;
  /// Forgets deflections and time; the pose stays.
  void rest() noexcept;

  const Pose& pose() const noexcept { return pose_; }
  double spin() const noexcept { return spin_; }
  const Vec3& velocity() const noexcept { return velocity_; }  ///< mm/s
  const Vec3& turning() const noexcept { return turning_; }    ///< rad/s

 private:
  RateSettings settings_;
  Pose pose_{};
  double spin_ = 0;
  Vec3 velocity_{0}, turning_{0};
  double time_ = 0;
  bool timed_ = false;
};

}  // namespace riffler::pen
