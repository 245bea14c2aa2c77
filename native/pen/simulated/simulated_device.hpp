// The simulated pen as a selectable device: it runs in the driver's own thread, in real time if the machine keeps up.
#pragma once

#include <memory>

#include "pen/driven_pen.hpp"
#include "pen/simulated/simulated_pen.hpp"
#include "pen/simulated/stall_tolerant_clock.hpp"
#include "riffler/pen/arms/compensation.hpp"

namespace riffler::pen {

inline constexpr const char* kSimulatedKind = "simulated";
inline constexpr const char* kSimulatedWhat = "Riffler pen without hardware, moved by a simulated hand";

/// Uses a StallTolerantClock: a busy machine must not take the force away from the hand that it simulates.
class SimulatedDevice final : public DrivenPen {
 public:
  /// A homed pen. Its hand moves on a curve (hand_on_a_curve) until it gets a target. Not in `real_time`, its clock
  /// runs as fast as the machine computes, which takes a whole processor, and push(), which holds for 20 ms of that
  /// clock, is of no use.
  static std::unique_ptr<SimulatedDevice> open(const SimulatedPenSettings& settings = {},
                                               const DriverSettings& driver = {},
                                               const CompensationShares& compensation = {}, bool real_time = true);

  /// The pen as it really is; geometry() is what its host believes.
  const PenGeometry& truth() const noexcept { return truth_; }

  double now() const noexcept override { return clock_->last(); }

  /// Moves the hand to a target at its own speed, as far as the arms reach; it lets go if the grip is 0. One thread
  /// only; never waits. Throws std::invalid_argument for values that are not finite, a zero axis, or a grip outside 0
  /// to 1.
  void aim(const HandWish& wish);
  /// Returns the hand to the curve. By the same thread.
  void wander() noexcept;
  /// Makes a counter read `counts` too few from now on, as an encoder that loses them one by one; relative to the
  /// original pen, not to earlier losses. Any thread. Throws std::invalid_argument for an unknown channel.
  void lose(std::size_t channel, std::int32_t counts);
  /// Hangs a weight on the grip as SimulatedWeight::hang, and with its exceptions. By the thread of aim().
  void hang(double mass, double hook);
  /// Pulls the cable out, or puts it in again: the driver then connects by itself. Any thread; never waits.
  void unplug() noexcept;
  void plug() noexcept;

 private:
  struct Hand;
  struct Load;
  struct Losses;
  SimulatedDevice(const PenGeometry& truth, std::shared_ptr<Hand> hand, std::shared_ptr<Losses> losses,
                  std::shared_ptr<Load> load, std::shared_ptr<PenModel> model, std::unique_ptr<Transport> transport,
                  Driver::Open open, const DriverSettings& driver, std::shared_ptr<StallTolerantClock> clock);

  PenGeometry truth_;
  std::shared_ptr<Hand> hand_;
  std::shared_ptr<Losses> losses_;
  std::shared_ptr<Load> load_;
  std::shared_ptr<StallTolerantClock> clock_;
};

}  // namespace riffler::pen
