// Limits on a wrench before it reaches the device. Every limit scales force and torque by one common factor: cutting
// the torque of a contact alone would push the hand in another direction.
#pragma once

#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Zero is allowed in every field and suppresses the output.
struct LimitSettings {
  Bounds wrench{5, 300};         ///< N, N·mm
  Bounds rate{2'000, 120'000};   ///< N/s, N·mm/s
  double power = 2'000;          ///< N·mm/s delivered to the hand: 2 W
  Bounds full_speed{300, 6};     ///< mm/s, rad/s: full force up to this speed
  Bounds no_force_at{1000, 20};  ///< mm/s, rad/s: no force from this speed on; linear in between

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Factor on the wrench for the speed of the grip, 0 to 1. 0 for a twist that is not a number.
double speed_gain(const LimitSettings& settings, const Twist& grip);

/// Largest factor, 0 to 1, with which force and torque are within their limits. The device's model enforces the limits
/// of single motors.
double magnitude_gain(const LimitSettings& settings, const Wrench& wrench);

/// The wrench that lies as far on the straight line from `previous` to `wanted` as the rates allow in `dt` (s). Returns
/// `previous` for dt ≤ 0.
Wrench slewed(const LimitSettings& settings, const Wrench& previous, const Wrench& wanted, double dt);

/// Factor, 0 to 1, that limits the power delivered to the hand to `power`. 1 for a wrench that takes energy from the
/// hand.
double power_gain(const LimitSettings& settings, const Wrench& wrench, const Twist& grip);

/// Which limits acted on a wrench, for display.
struct LimitReport {
  Wrench unrendered;  ///< part of the wrench that the device cannot push
  double speed = 1, magnitude = 1, power = 1;
  bool slewed = false;
};

/// Applies all limits: the device's capability, speed, magnitude, rate and power. From one tick to the next the wrench
/// changes by at most rate · dt, or is a scaled-down form of a wrench that does: safety reductions are never delayed.
Wrench limited(const LimitSettings& settings, const Capability& device, const Wrench& previous, const Wrench& wanted,
               const Twist& grip, double dt, LimitReport* report = nullptr);

}  // namespace riffler::haptics
