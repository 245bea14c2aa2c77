// Time-domain passivity: an observer keeps an account of the energy that the rendered force took from the hand, and a
// controller limits what it gives back to that account (Hannaford and Ryu, "Time-domain passivity control of haptic
// interfaces", IEEE Trans. Robotics and Automation 18(1), 2002; series type, for impedance devices).
//
// Two things differ from the paper. First, the energy of a hold is known exactly at the tick that ends it: wrench held
// · displacement since (Stramigioli, Secchi, van der Schaft and Fantuzzi, IEEE Trans. Robotics 21(4), 2005). The
// account therefore has no sampling error. Second, the controller does not wait for a debt. The grip's acceleration is
// bounded, so its next displacement is known up to an uncertainty; the controller passes no wrench that could deliver
// more than the account holds for any displacement within it. While the bounds hold, the account never falls below
// zero. A tick that breaks them leaves a debt, which is recorded and repaid before anything else is delivered. With a
// transmission delay, the same rule covers all wrenches still in transit (PassivitySettings::latency).
//
// One account serves all coordinates. Energy per coordinate depends on the choice of axes and pivot, and a passive
// object may take it in one coordinate and return it in another for ever: a spring whose principal axes are not the
// coordinate axes does so on an elliptic path, by a constant amount per turn. The sum over all coordinates is what the
// hand receives and depends on no such choice. The sums per coordinate are kept for display.
#pragma once

#include "riffler/haptics/settings.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Timing, device data and energy limits of the passivity controller.
struct PassivitySettings {
  double period = 1e-3;  ///< s: nominal duration of a hold
  double jitter = 1e-4;  ///< s: a hold may be shorter or longer by this
  /// s from passing a wrench to the end of the hold with it, as accounted; at most 8 periods. Wrenches in transit count
  /// against the account; the longer the delay, the less certain the hand's position and the softer a wall can be.
  double latency = 0;
  /// N/s, N·mm/s: the device's own limit on changes; what it applies follows a new wrench at least this fast. 0: at
  /// once. A force that falls so slowly delivers energy after the controller has asked for zero, so that counts, too.
  Bounds device_rate{0, 0};
  Bounds acceleration{1e5, 1e3};  ///< mm/s², rad/s²: bound on the grip's acceleration per coordinate
  Bounds resolution{0.03, 2e-3};  ///< mm, rad: resolution of the measured position
  Bounds max_damping{2e-3, 2};    ///< N·s/mm, N·mm·s/rad: largest injected damping
  // The device's own dissipation lets the account sustain a sampled wall within its passive bound indefinitely. Without
  // it the reserve is eventually spent, and contacts then begin soft.
  Bounds device_damping{0, 0};   ///< N·s/mm, N·mm·s/rad: guaranteed viscous damping in every direction
  Bounds device_friction{0, 0};  ///< N, N·mm: guaranteed dry friction per coordinate; 1/√3 of isotropic friction
  double reserve = 1;            ///< N·mm: initial balance of the account
  double storage = 50;           ///< N·mm, ≥ reserve: largest energy that rendered objects can store

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

/// Energy account and controller of one device. Not thread-safe.
class Passivity {
 public:
  /// Throws std::invalid_argument for invalid settings.
  explicit Passivity(const PassivitySettings& settings);

  /// Records the hold that ends now. `held`: the wrench that the motors really applied; `displacement` of the grip
  /// during the hold, about the same pivot; `dt`: s. Values that are not finite are not recorded, and the grip counts
  /// as at rest. `dissipated`: N·mm that the device itself certainly took from the motion during the hold, in addition
  /// to device_damping and device_friction; below zero or not finite counts as zero.
  void observe(const Wrench& held, const Twist& displacement, double dt, double dissipated = 0);

  /// The wrench to hold next. Returns `wanted` if the account covers it, otherwise `wanted` with the damping needed, up
  /// to max_damping; if that is not enough, `wanted` shrinks, to zero at worst. Damping is injected only where the
  /// direction of the grip's motion is certain: below that, the measured velocity is noise, and amplified noise would
  /// be felt.
  Wrench control(const Wrench& wanted, const Capability& device);

  /// Energy that may go to the hand, N·mm; negative: a debt.
  double energy() const { return energy_; }
  /// Factor on the wanted wrench and share of max_damping in the last wrench: (1, 0) means unchanged.
  double kept() const { return kept_; }
  double damped() const { return damped_; }
  /// Starts a new account. Nothing else sets the account: trips and ramps keep a debt.
  void reset();

 private:
  /// Uncertainty of coordinate k (mm or rad) at the end of the hold that begins after `ahead` others, about the
  /// position that its rate predicts.
  double unsure(int k, double rate, std::size_t ahead) const;
  /// Energy that wrenches in transit may still deliver, N·mm. Moves `applied` from what the device applies now to what
  /// it applies then.
  double on_the_way(const Capability& device, Wrench& applied) const;
  /// s that the device takes for a change.
  double duration(const Wrench& change) const;
  Wrench followed(const Wrench& applied, const Wrench& wanted) const;
  /// Energy that a wrench delivers while the device lets it fall to zero, at the mean rate: an estimate.
  double fall(const Wrench& applied) const;
  double dissipated(const Twist& displacement, double dt);

  PassivitySettings settings_;
  double energy_;
  Twist rate_{};       // mean over the last tick
  Twist mean_rate_{};  // mean over a few ticks
  Wrench applied_{};   // in the last hold
  double last_dt_;
  Twist way_{};  // per coordinate: displacement and time since the device's own dissipation was last credited
  std::array<double, kCoordinates> way_time_{};
  double kept_ = 1, damped_ = 0;
  static constexpr std::size_t kMaxOnTheWay = 8;
  std::array<Wrench, kMaxOnTheWay> on_the_way_{};  // the first `waiting_`, oldest first
  std::size_t waiting_ = 0;
};

}  // namespace riffler::haptics
