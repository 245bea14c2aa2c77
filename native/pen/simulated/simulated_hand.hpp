// A human hand on the simulated pen's grip: a mass on a spring and damper whose other end follows the hand's target
// (Hogan, "Controlling impedance at the man/machine interface", ICRA 1989). It trembles, grips more or less firmly, and
// yields beyond its strength.
#pragma once

#include <cstdint>
#include <functional>

#include "pen/simulated/simulated_dynamics.hpp"

namespace riffler::pen {

/// Values at full grip; a looser grip scales all of them. Assumed, of the magnitude of measurements at a pen's grip.
struct HandSettings {
  double mass = 0.03, inertia = 20;      ///< kg, kg·mm²: fingers that move with the grip
  haptics::Bounds stiffness{0.5, 1000};  ///< N/mm, N·mm/rad
  haptics::Bounds damping{5e-3, 10};     ///< N·s/mm, N·mm·s/rad
  haptics::Bounds strength{10, 400};     ///< N, N·mm: largest force of the spring
  haptics::Bounds haste{300, 5};         ///< mm/s, rad/s: largest speed at which the aim follows the target
  double tremor = 0.02;                  ///< mm, amplitude along each axis
  double tremor_frequency = 9;           ///< Hz
  double carries = 1;                    ///< fraction of the pen's weight that the hand supports without sagging

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// The hand's target. Trivially copyable.
struct HandWish {
  Pose pose{};      ///< of the grip, pose frame
  double spin = 0;  ///< rad, of the grip about its axis: no motor acts on it, so it follows at once
  double grip = 1;  ///< firmness, 0 (released) to 1
  std::uint32_t buttons = 0;
};

/// Target as a function of the seconds since the pen's creation. Called in the thread that moves the pen; must not wait
/// or throw.
using HandPath = std::function<HandWish(double seconds)>;

/// Rests at `home` for a second, then follows a closed curve in space, about 20 mm in each direction and leaning by up
/// to 0.2 rad, and turns the grip about its axis. Button 1 is held on every other round.
HandPath hand_on_a_curve(const Pose& home);
/// Holds still at `pose`.
HandPath hand_at(const Pose& pose, double grip = 1);

class SimulatedHand {
 public:
  /// Throws std::invalid_argument for invalid settings.
  SimulatedHand(const HandSettings& settings, HandPath path, const Pose& start);

  void follow(HandPath path) { path_ = std::move(path); }
  /// Adds the hand's action on the grip to `load`, `seconds` after the pen's creation and `dt` (s) after the last call.
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
