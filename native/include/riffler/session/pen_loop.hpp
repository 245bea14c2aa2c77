// What the loops of sculpting and of orienting do in every tick: safety checks before the tool's step, limits after it,
// and the record for the thread that displays.
#pragma once

#include <atomic>

#include "riffler/base/ring.hpp"
#include "riffler/haptics/wrench_extrapolator.hpp"
#include "riffler/pen/pen_step.hpp"
#include "riffler/session/force_gate.hpp"

namespace riffler::session {

/// `Tick`: the record of one tick, as SculptTick.
template <class Tick>
class PenLoop : public pen::PenStep {
 public:
  static constexpr std::size_t kTicks = 4096;  ///< capacity of the queue of ticks for the display

  // By the displaying thread. None of these waits.

  /// The next tick not taken yet; false if there is none.
  bool take(Tick& tick) noexcept { return ticks_.take(tick); }
  /// Number of ticks lost because the queue was full.
  std::uint64_t dropped_ticks() const noexcept { return dropped_ticks_.load(); }

  // By any thread.

  /// Clears a trip in the next tick.
  void reset() noexcept { reset_.store(true); }
  /// From the next tick on the dead-man switch counts as released: the force falls to zero, and then it is `quiet`.
  void let_go() noexcept { gate_.let_go(); }
  bool quiet() const noexcept { return gate_.quiet(); }
  const haptics::TripLog& trips() const noexcept { return gate_.trips(); }

 protected:
  /// `settings`: valid settings of the loop. `absolute`: the tool starts at the hand, otherwise at `tool`.
  template <class Settings>
  PenLoop(const Settings& settings, const pen::DeviceCapability& device, const Pose& tool, bool absolute)
      : gate_(settings.limits, settings.passivity, settings.safety, device),
        wrench_extrapolator_(settings.wrench_extrapolator),
        last_tool_(tool),
        absolute_(absolute) {}

  /// Before the tool's step. `dead_man_mask`: buttons of which one must be held for force; 0: none.
  Tick begin(const pen::PenSample& sample, double now, double dt, std::uint32_t dead_man_mask) noexcept {
    Tick tick;
    if (dt > 0) time_ += dt;
    tick.time = time_, tick.dt = dt, tick.grip = sample.pose;
    if (reset_.exchange(false)) gate_.reset();
    if (dt == 0) placed_ = false;  // a new connection: the hand may have moved anywhere
    gate_.begin(sample, now, dt, dead_man_mask == 0 || (sample.buttons & dead_man_mask) != 0);
    return tick;
  }

  /// After the tool's step, with the wrench that it `wanted` on the hand.
  haptics::SafeWrench release(const pen::PenSample& sample, const Wrench& wanted, double dt, Tick& tick) noexcept {
    const haptics::SafeWrench safe = gate_.release(sample, wanted, dt);
    tick.wrench = gate_.held(), tick.energy = gate_.energy();
    tick.state = gate_.state(), tick.cause = gate_.cause();
    return safe;
  }

  void put(const Tick& tick) noexcept {
    if (!ticks_.put(tick)) dropped_ticks_.fetch_add(1, std::memory_order_relaxed);
  }

  /// The wrench of a tick without a step of the tool. `why`: a sentence for the user, or null.
  Wrench missed(double dt, const char* why, Tick& tick) noexcept {
    tick.missed = true, tick.problem = why;
    return wrench_extrapolator_.missed(dt);
  }

  // Used by the device's thread only.
  ForceGate gate_;
  haptics::WrenchExtrapolator wrench_extrapolator_;
  Pose last_tool_;
  double time_ = 0, owed_ = 0;  // s; the second: time since the last completed step
  bool placed_ = false, absolute_;

 private:
  base::Ring<Tick> ticks_{kTicks};
  std::atomic<std::uint64_t> dropped_ticks_{0};
  std::atomic<bool> reset_{false};
};

}  // namespace riffler::session
