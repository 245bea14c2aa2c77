// What stands between a computed wrench and the device: safety checks, energy account and limits, in the order of
// haptics/safety.hpp.
#pragma once

#include <atomic>

#include "riffler/haptics/limits.hpp"
#include "riffler/haptics/passivity.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/pen/capability.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::session {

/// In these states the device knows its pose and its data are fresh.
inline bool sure(haptics::ForceState state) {
  return state == haptics::ForceState::Ready || haptics::lets_force_through(state);
}

/// The safety settings for a device: one without force may jump and pause like a mouse, since nothing pushes the hand.
haptics::SafetySettings for_device(haptics::SafetySettings settings, const pen::DeviceCapability& device);

/// The checks of one loop. Per tick: begin(), then release(). Used by the device's thread only, except trips().
class ForceGate {
 public:
  /// Throws std::invalid_argument for invalid settings.
  ForceGate(const haptics::LimitSettings& limits, const haptics::PassivitySettings& passivity,
            const haptics::SafetySettings& safety, const pen::DeviceCapability& device);

  /// Runs the checks of the tick and settles the energy of the wrench held since the last one. `dt` = 0: a new
  /// connection, before which the hand may have moved anywhere. Returns the force state.
  haptics::ForceState begin(const pen::PenSample& sample, double now, double dt, bool dead_man);
  /// The wrench to hold until the next tick, for the `wanted` one; while a force falls (Safety::falling), for the last
  /// that was wanted before.
  haptics::SafeWrench release(const pen::PenSample& sample, const Wrench& wanted, double dt);
  /// Any thread: from the next tick on the dead-man switch counts as released.
  void let_go() noexcept { let_go_.store(true); }
  /// Any thread: no force was released in the last tick.
  bool quiet() const noexcept { return quiet_.load(); }
  /// Clears a trip that does not heal by itself.
  void reset() { safety_.reset(); }

  haptics::ForceState state() const { return safety_.state(); }
  haptics::Cause cause() const { return safety_.cause(); }
  /// Wrench that acted until this tick: as the device reports it, otherwise as released.
  const Wrench& applied() const { return applied_; }
  /// Wrench of the last release.
  const Wrench& held() const { return held_; }
  /// Balance of the energy account, N·mm.
  double energy() const { return passivity_.energy(); }
  /// Any thread.
  const haptics::TripLog& trips() const { return safety_.log(); }

 private:
  haptics::LimitSettings limits_;
  pen::DeviceCapability device_;
  haptics::Safety safety_;
  haptics::Passivity passivity_;
  double dissipated_ = 0;                    // PenSample::dissipated of the last tick
  Wrench wanted_, slewed_, held_, applied_;  // slewed_: before the passivity controller
  Pose last_grip_;
  bool has_grip_ = false;
  std::atomic<bool> let_go_{false}, quiet_{true};
};

}  // namespace riffler::session
