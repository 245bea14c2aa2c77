// Time-domain passivity: an observer that keeps the account of the energy that rendering took from the hand, and a
// controller that lets it go back no further than that (Hannaford and Ryu, "Time-domain passivity control of haptic
// interfaces", IEEE Trans. Robotics and Automation 18(1), 2002; series type, for impedance devices).
//
// Two things are done differently. A hold's energy is known exactly at the tick that ends it, wrench held ·
// displacement since (Stramigioli, Secchi, van der Schaft and Fantuzzi, IEEE Trans. Robotics 21(4), 2005), so the
// account has no error of sampling. And the controller does not wait for a debt. The grip's acceleration is bounded, so
// its next displacement is known up to an uncertainty; no wrench is let through which could deliver more than the
// account holds, wherever in there the grip goes. While the bounds hold, the account is never below zero; a tick that
// breaks them leaves a debt, which is accounted and paid before anything else is delivered. Behind a cable the same
// holds of all wrenches that are still on their way (PassivitySettings::latency).
//
// One account serves all coordinates. Energy per coordinate depends on the choice of axes and pivot, and a passive
// object may take it in one and give it back in another for ever (a spring whose principal axes are not the coordinates
// does, on an elliptic path: a constant sum per turn); the sum over all is what the hand gets, and depends on nothing.
// The coordinates' own sums are kept to be looked at.
#pragma once

#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

struct PassivitySettings {
  double period = 1e-3;  ///< s: the hold that is counted on
  double jitter = 1e-4;  ///< s: by how much it may be shorter or longer
  /// s from a wrench that is let through to the hold with it, and back to its account, at most 8 periods. Wrenches on
  /// their way have to be borne, too; the less is sure of where the hand will be then, the less stiff a wall can be.
  double latency = 0;
  Bounds acceleration{1e5, 1e3};  ///< mm/s², rad/s²: of the grip, per coordinate
  Bounds resolution{0.03, 2e-3};  ///< mm, rad: step of the measured position
  Bounds max_damping{2e-3, 2};    ///< N·s/mm, N·mm·s/rad: the most that is injected
  // What the device takes from the hand by itself is what lets a wall within its passive bound be sampled at a loss for
  // ever: without it, the reserve is spent some day, and contacts begin soft.
  Bounds device_damping{0, 0};   ///< what the device surely has, in whatever direction
  Bounds device_friction{0, 0};  ///< N, N·mm: surely, in each coordinate; of one that is the same all round, 1/√3
  double reserve = 1;            ///< N·mm that rendering may owe to nobody: where the account starts
  double storage = 50;           ///< N·mm, ≥ reserve: the most that rendered objects can hold

  /// std::invalid_argument naming the field.
  void validate() const;
};

class Passivity {
 public:
  /// Validates the settings.
  explicit Passivity(const PassivitySettings& settings);

  /// The hold that ends now: the wrench that the device's motors really had, and how far the grip has gone meanwhile,
  /// about the same pivot, in dt seconds. Without finite numbers nothing is accounted and the grip counts as at rest.
  void observe(const Wrench& held, const Twist& displacement, double dt);

  /// The wrench to hold next: `wanted` if the account bears it, otherwise with as much damping as that takes, up to
  /// max_damping; if that is not enough, `wanted` shrinks, to nothing at the worst. Damping is injected only where the
  /// grip's direction is sure: below that, measured velocity is noise, and amplified would be felt.
  Wrench control(const Wrench& wanted, const Capability& device);

  /// N·mm that may go to the hand; below zero a debt.
  double energy() const { return energy_; }
  /// Factor of the wanted wrench and share of max_damping in the last wrench let through: (1, 0) is untouched.
  double kept() const { return kept_; }
  double damped() const { return damped_; }
  /// A new session. Otherwise the account is never set: trips and ramps leave debts as they are.
  void reset();

 private:
  /// How far coordinate k may end from where its rate leads, in the hold that begins after `ahead` others, mm or rad.
  double unsure(int k, double rate, std::size_t ahead) const;
  /// N·mm that wrenches on their way may still deliver.
  double on_the_way(const Capability& device) const;
  double dissipated(const Twist& displacement, double dt);

  PassivitySettings settings_;
  double energy_;
  Twist rate_{};  // mean over the last tick
  double last_dt_;
  Twist way_{};  // since the device's own dissipation was credited last, and for how long: by coordinate
  std::array<double, kCoordinates> way_time_{};
  double kept_ = 1, damped_ = 0;
  static constexpr std::size_t kMaxOnTheWay = 8;
  std::array<Wrench, kMaxOnTheWay> on_the_way_{};  // the first `waiting_`, oldest first
  std::size_t waiting_ = 0;
};

}  // namespace riffler::haptics
