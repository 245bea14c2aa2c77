// A fault on trial, on the whole stack: firmware, cable, codec, model, driver's loop and gate, with a hand on a
// simulated pen. It is injected while the pen pushes, must take the force away within its time, and after it is gone
// the force comes back by the ramp. The loop runs on all the while: every wait is virtual, so a dead lock would be a
// test without end.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <set>
#include <utility>

#include "pen/simulated/simulated_bench.hpp"

namespace riffler::test {

inline constexpr double kWatchdog = 0.0203;  // s: the firmware's, and a turn of its loop
// s: from what the encoders read to motors without current, where the host finds the fault: a report, a tick that takes
// the force away, the answer's frame and a turn, and 4 ms of the firmware's 100 mA/ms.
inline constexpr double kRound = 0.0075;

inline pen::SimulatedPenSettings with(const std::function<void(pen::SimulatedPenSettings&)>& change) {
  pen::SimulatedPenSettings settings;
  change(settings);
  return settings;
}

/// A bench that pushes with 0.7 N upward, 350 mA of the 400 from which a joint without a count is a stall, and what
/// its motors did.
struct Trial {
  explicit Trial(pen::HandPath path = nullptr, const pen::SimulatedPenSettings& settings = {})
      : bench(settings, std::move(path)) {
    bench.step.law = [this](const pen::PenSample&, double, double) { return Wrench{{0, 0, newtons}, {}}; };
    bench.pen->on_turn = [this] {
      if (bench.pen->firmware().fault != 0) faults.insert(bench.pen->firmware().fault);
      double most = 0;
      for (const std::int16_t c : bench.pen->drive().current_ma)
        if (bench.pen->drive().power) most = std::max(most, std::abs(static_cast<double>(c)));
      const double now = 1e-6 * static_cast<double>(bench.pen->time_us());
      if (most > 0) last_pushed = now;
      if (most == 0) risen_from = now;
      // The force may be as large as the share of the ramp's half second that has passed, in two gates in series.
      steepest = std::max(steepest, most - full * std::min(1.0, (now - risen_from) / 0.4));
      current = most;
    };
  }
  /// Pushing at full for at least a second.
  void start() {
    bench.run(2);
    EXPECT_EQ(bench.pen->firmware().state, RIFFLER_PEN_ACTIVE);
    EXPECT_EQ(bench.step.safety.state(), haptics::ForceState::Active);
    full = 1.15 * current;
    steepest = 0;
    EXPECT_GT(current, 50);
    injected = bench.now();
  }
  /// For `seconds`, in which the motors must have gone to zero within `within` of the fault, and stayed.
  void goes_dead(double within, double seconds = 0.3) {
    bench.run(seconds);
    EXPECT_LE(last_pushed, injected + within);
    EXPECT_EQ(current, 0);
  }
  /// The fault is gone: force comes back by the ramp, to what it was; a fault that does not heal by itself needs its
  /// trip to be cleared first.
  void comes_back(double settles = 0.1) {
    bench.run(settles);
    steepest = 0;
    if (!heals(cause())) bench.step.safety.reset();
    bench.run(2.5);
    EXPECT_EQ(bench.loop.status().state, pen::LinkState::Connected);
    EXPECT_EQ(bench.pen->firmware().state, RIFFLER_PEN_ACTIVE);
    EXPECT_EQ(bench.step.safety.state(), haptics::ForceState::Active) << sentence(cause());
    EXPECT_GT(current, 0.7 * full);
    EXPECT_LE(steepest, 0.05 * full) << "faster than the ramp";
    EXPECT_EQ(bench.step.pushed_while_tripped, 0);
  }
  /// The same for a fault that heals by itself: a part was late and is late no more, and no trip has to be cleared.
  void heals_by_itself() {
    bench.run(0.1);
    EXPECT_TRUE(haptics::heals(cause())) << sentence(cause());
    comes_back();
  }
  haptics::Cause cause() const { return bench.step.safety.cause(); }
  bool tripped_by(haptics::Cause cause) {
    std::array<haptics::Trip, 64> trips{};
    std::uint64_t from = 0;
    const std::size_t n = bench.step.safety.log().read(from, trips);
    for (std::size_t k = 0; k < n; ++k)
      if (trips[k].cause == cause) return true;
    return false;
  }
  void falsify(std::function<void(riffler_pen_sensors&)> sensors) { bench.pen->on_sense = std::move(sensors); }
  void mend() { bench.pen->on_sense = nullptr; }

  std::set<int> faults;  // of the firmware, so far
  double newtons = 0.7, full = 1e300, current = 0, steepest = 0, last_pushed = 0, risen_from = 0, injected = 0;
  SimulatedBench bench;
};

inline Pose home_pose() {
  return pen::SimulatedPen(pen::SimulatedPenSettings()).arms().posture().pose;
}

/// Along a line, forth and back, `way` mm a second.
inline pen::HandPath hand_to_and_fro(const Vec3& direction, double way) {
  return [home = home_pose(), direction, way](double t) {
    pen::HandWish wish{.pose = home};
    wish.pose.tip += way / 3 * std::sin(3 * std::max(0.0, t - 1)) * direction;
    return wish;
  };
}

}  // namespace riffler::test
