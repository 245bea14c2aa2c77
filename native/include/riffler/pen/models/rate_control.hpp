// Rate control: a puck's deflection sets speeds that are integrated to a pose.
#pragma once

#include <array>

#include "riffler/geom/pose.hpp"

namespace riffler::pen {

/// Response of a puck.
struct RateSettings {
  double bubble = 0.08;    ///< dead zone as a fraction of full deflection, over all three directions together
  double exponent = 2;     ///< exponent of the response from the edge of the bubble to full deflection; 1: linear
  double speed = 60;       ///< mm/s at full deflection
  double turn_rate = 1.5;  ///< rad/s at full deflection
  bool hold_orientation = false;               ///< no rotation: the tool keeps its axis
  bool hold_position = false;                  ///< no translation
  std::array<int, 6> signs{1, 1, 1, 1, 1, 1};  ///< −1, 0 or 1 for x y z a b c, applied first

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Response to a deflection in fractions of full, each −1 … 1. The bubble is a ball and the curve acts on the length,
/// so the direction is kept: separate dead zones per axis would bend slow motions towards the axes. Continuous, and
/// zero in the bubble. NaN counts as rest.
Vec3 shaped(const Vec3& deflection, double bubble, double exponent) noexcept;

/// Integrates the deflections of a puck to a pose.
class RateControl {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit RateControl(const RateSettings& settings = {});

  /// Sets the tool's pose.
  void place(const Pose& pose) noexcept { pose_ = pose; }
  /// Sets the deflection (translation and rotation as fractions of full) from now on.
  void push(const Vec3& translation, const Vec3& rotation) noexcept;
  /// Integrates up to `now` (s). Steps longer than 0.1 s, as after suspend, count as 0.1 s.
  void advance(double now) noexcept;
  /// Clears deflection and time; the pose stays.
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
