// A human hand on the simulated pen's grip: a mass on a spring and a damper, whose other end goes where the hand wants
// to go (Hogan, "Controlling impedance at the man/machine interface", ICRA 1989). It trembles, grips more or less
// firmly, and gives way beyond its force.
#pragma once

#include <cstdint>
#include <functional>

#include "pen/simulated/simulated_dynamics.hpp"

namespace riffler::pen {

/// At full grip; a looser grip has that share of all of it. Assumed, of the size that measurements at a pen's grip
/// have.
struct HandSettings {
  double mass = 0.03, inertia = 20;      ///< kg, kg·mm²: of fingers that move with the grip
  haptics::Bounds stiffness{0.5, 1000};  ///< N/mm, N·mm/rad
  haptics::Bounds damping{5e-3, 10};     ///< N·s/mm, N·mm·s/rad
  haptics::Bounds strength{10, 400};     ///< N, N·mm: of the spring, which gives way beyond
  haptics::Bounds haste{300, 5};         ///< mm/s, rad/s: at which the hand's aim follows what is wanted, at most
  double tremor = 0.02;                  ///< mm, amplitude along each axis
  double tremor_frequency = 9;           ///< Hz
  double carries = 1;                    ///< share of the pen's weight that the hand bears without sagging

  /// std::invalid_argument naming the field.
  void validate() const;
};

/// Where a hand wants to go. Trivially copyable.
struct HandWish {
  Pose pose{};      ///< of the grip, frame of poses
  double spin = 0;  ///< rad, of the grip about its axis: no motor turns it, so it follows at once
  double grip = 1;  ///< 0, let go, to 1
  std::uint32_t buttons = 0;
};

/// Of seconds since the pen was made. Called in the thread that moves the pen; must not wait or throw.
using HandPath = std::function<HandWish(double seconds)>;

/// Rests at `home` for a second, then goes round on a closed curve in space, some 20 mm to all sides and leaning by up
/// to 0.2 rad, and turns the grip about itself; button 1 is held on every other round.
HandPath hand_on_a_curve(const Pose& home);
/// Holds still.
HandPath hand_at(const Pose& pose, double grip = 1);

class SimulatedHand {
 public:
  /// Validates the settings.
  SimulatedHand(const HandSettings& settings, HandPath path, const Pose& start);

  void follow(HandPath path) { path_ = std::move(path); }
  /// What it does to the grip `seconds` after the pen was made, `dt` after the last call. Adds to `load`.
  void hold(const PenDynamics& pen, double seconds, double dt, PenLoad& load);
  /// As of the last call.
  const HandWish& wish() const { return wish_; }

 private:
  Vec3 tremor(double seconds) const;
  Twist aim(double dt);

  HandSettings settings_;
  HandPath path_;
  HandWish wish_{};
  Pose aim_;
};

}  // namespace riffler::pen
