// What a wrench is cut down to before a device gets it. All of it keeps the wrench's direction, in six dimensions:
// force and torque shrink by one factor, since a contact whose torque is cut alone would push the hand another way.
#pragma once

#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Zero in any field is allowed, and lets nothing through.
struct LimitSettings {
  Bounds wrench{5, 300};         ///< N, N·mm
  Bounds rate{2'000, 120'000};   ///< N/s, N·mm/s
  double power = 2'000;          ///< N·mm/s delivered to the hand: 2 W
  Bounds full_speed{300, 6};     ///< mm/s, rad/s: up to here everything
  Bounds no_force_at{1000, 20};  ///< mm/s, rad/s: from here nothing; between the two a straight line

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// In [0, 1]: by how much the speed of the grip cuts the wrench. Not a number: 0.
double speed_gain(const LimitSettings& settings, const Twist& grip);

/// In [0, 1]: the largest factor with which force and torque are within their limits. A motor's own limit is kept by
/// the device's model.
double magnitude_gain(const LimitSettings& settings, const Wrench& wrench);

/// From `previous` on the straight line to `wanted`, as far as the rates allow in dt (s; nothing for dt ≤ 0).
Wrench slewed(const LimitSettings& settings, const Wrench& previous, const Wrench& wanted, double dt);

/// In [0, 1]: cuts what is delivered to the hand to `power`. A wrench that takes energy from the hand is left alone.
double power_gain(const LimitSettings& settings, const Wrench& wrench, const Twist& grip);

/// What held a wrench back, to be shown.
struct LimitReport {
  Wrench unrendered;  ///< what the device cannot push
  double speed = 1, magnitude = 1, power = 1;
  bool slewed = false;
};

/// All of the above: what the device can push, by its speed, magnitudes, rates and power. From one tick to the next the
/// wrench changes by no more than rate · dt, or it is a shrunk form of one that does: cuts for the sake of safety are
/// never delayed.
Wrench limited(const LimitSettings& settings, const Capability& device, const Wrench& previous, const Wrench& wanted,
               const Twist& grip, double dt, LimitReport* report = nullptr);

}  // namespace riffler::haptics
