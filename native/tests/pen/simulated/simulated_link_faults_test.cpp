// Faults of time, cable and step, injected on the whole stack.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "pen/simulated/simulated_trial.hpp"
#include "support/effort.hpp"

namespace riffler::pen::simulated_link_faults_test {
namespace {

using test::home_pose;
using test::kRound;
using test::kWatchdog;
using test::Trial;

/// --- Time: ticks that are late, hosts and processors that stand still. ------------------------------------------ ///

TEST(SimulatedFault, LateTicksFadeTheForceAndFromTheWatchdogOnTakeItAway) {
  for (const double late : {0.002, 0.005, 0.010, 0.015, 0.019, 0.0215, 0.030, 0.040}) {
    if (test::kSanitized && late != 0.002 && late != 0.010 && late != 0.030) continue;  // one of each kind
    SCOPED_TRACE(late);
    Trial t;
    t.start();
    bool once = true;
    double least = 1e300;
    t.bench.step.law = [&](const PenSample&, double, double) {
      if (std::exchange(once, false)) t.bench.clock->wait(late);
      return Wrench{{0, 0, t.newtons}, {}};
    };
    t.bench.step.after = [&](const Wrench& w) { least = std::min(least, glm::length(w.force)); };
    t.bench.run(0.06);
    if (late > 0.021) {
      EXPECT_EQ(least, 0);
      EXPECT_LE(t.last_pushed, t.injected + kWatchdog + 2e-3);  // two reports were in transit
      EXPECT_EQ(t.faults, std::set<int>{RIFFLER_PEN_WATCHDOG});
      EXPECT_TRUE(t.tripped_by(haptics::Cause::DeviceLate));  // the pen's word comes before the host's own finding
    } else if (late > 0.003) {
      EXPECT_LT(least, t.newtons * (1.01 - (late - 0.003) / 0.017));
      EXPECT_EQ(t.bench.pen->firmware().fault_count, 0);
    } else {
      EXPECT_GT(least, 0.99 * t.newtons);
    }
    t.heals_by_itself();
  }
}

/// A step that overruns every time, by more than the watchdog's time: never more than the ramp's beginning.
TEST(SimulatedFault, AStepThatAlwaysOverrunsPushesWithNothing) {
  Trial t;
  t.start();
  t.bench.step.law = [&](const PenSample&, double, double) {
    t.bench.clock->wait(0.03);
    return Wrench{{0, 0, t.newtons}, {}};
  };
  t.goes_dead(kWatchdog + 2e-3, 1);
  EXPECT_TRUE(t.tripped_by(haptics::Cause::DeviceLate));
  t.bench.step.law = [&](const PenSample&, double, double) { return Wrench{{0, 0, t.newtons}, {}}; };
  t.heals_by_itself();
}

TEST(SimulatedFault, AHostThatDiesIsMissedWithinTheWatchdogsTime) {
  Trial t;
  t.start();
  t.bench.run_alone(0.5);
  EXPECT_LE(t.last_pushed, t.injected + kWatchdog + 2e-3);
  EXPECT_GE(t.last_pushed, t.injected + 0.015);  // and not much before
  EXPECT_EQ(t.bench.pen->firmware().fault, RIFFLER_PEN_WATCHDOG);
  EXPECT_EQ(t.current, 0);
  t.heals_by_itself();
}

TEST(SimulatedFault, AProcessorThatStandsStillIsSwitchedOffByTheBoard) {
  Trial t;
  t.start();
  t.bench.pen->halt(200'000);
  t.goes_dead(0.0105, 0.19);
  EXPECT_TRUE(t.tripped_by(haptics::Cause::Stale) || t.tripped_by(haptics::Cause::LateTick));
  t.bench.run(0.05);
  EXPECT_GT(t.bench.pen->firmware().fault_count, 0);  // late step
  t.heals_by_itself();
}

TEST(SimulatedFault, AFirmwareThatIsLateWhileItPushesFindsItItself) {
  Trial t;
  t.start();
  t.bench.pen->halt(7'000);
  t.goes_dead(0.0075, 0.1);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 1);
  t.heals_by_itself();
}

/// --- The cable. --------------------------------------------------------------------------------------------------
/// ///

TEST(SimulatedFault, AllReportsToTheHostAreLost) {
  Trial t;
  t.start();
  t.bench.pen->cable().set({.lost = 1});
  t.goes_dead(0.020 + kRound, 0.2);
  EXPECT_TRUE(t.tripped_by(haptics::Cause::Stale) || t.tripped_by(haptics::Cause::LateTick));
  t.bench.run(0.3);  // silent for longer than the driver waits: closed, and looked for
  EXPECT_EQ(t.bench.loop.status().counts.silences, 1U);
  t.bench.pen->cable().set({});
  t.comes_back();
}

TEST(SimulatedFault, AllReportsToThePenAreLost) {
  Trial t;
  t.start();
  t.bench.pen->cable().set({.lost_out = 1});
  t.goes_dead(kWatchdog + 2e-3);
  EXPECT_TRUE(t.tripped_by(haptics::Cause::DeviceLate));
  t.bench.pen->cable().set({});
  t.heals_by_itself();
}

TEST(SimulatedFault, ReportsThatAreLostDoubledMergedAndLateNowAndThenChangeNothing) {
  Trial t(hand_on_a_curve(home_pose()));
  t.start();
  t.bench.pen->cable().set(
      {.jitter_us = 1200, .lost = 0.05, .doubled = 0.05, .merged = 0.05, .lost_out = 0.05, .seed = 3});
  const std::uint64_t trips = t.bench.step.safety.log().count();
  t.bench.run(5);
  const LinkCounts counts = t.bench.loop.status().counts;
  EXPECT_GT(counts.lost, 150U);
  EXPECT_GT(counts.old, 150U);
  EXPECT_GT(counts.superseded, 50U);
  EXPECT_EQ(counts.malformed, 0U);
  EXPECT_EQ(t.bench.step.safety.log().count(), trips);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 0);
  t.bench.pen->cable().set({});
  t.comes_back();
}

TEST(SimulatedFault, UnpluggedAndPluggedInAgain) {
  Trial t;
  t.start();
  t.bench.pen->unplug();  // read gives −1
  t.goes_dead(kWatchdog + 2e-3, 0.5);
  EXPECT_EQ(t.bench.loop.status().counts.read_errors + t.bench.loop.status().counts.write_errors, 1U);
  EXPECT_NE(t.bench.loop.status().state, LinkState::Connected);
  EXPECT_EQ(t.bench.loop.status().wrench, Wrench{});
  t.bench.pen->plug();
  t.comes_back(2);
  EXPECT_EQ(t.bench.loop.status().counts.connections, 2U);
}

TEST(SimulatedFault, UnpluggedTenTimesAtAllMomentsOfAFrame) {
  Trial t;
  t.start();
  for (int k = 0; k < 10; ++k) {
    t.bench.run_alone(1e-4 * k);
    t.injected = t.bench.now();
    t.bench.pen->unplug();
    t.goes_dead(kWatchdog + 2e-3, 0.05);
    t.bench.pen->plug();
    t.bench.run(0.3);
  }
  t.comes_back(2);
  EXPECT_EQ(t.bench.loop.status().counts.connections, 11U);
}

TEST(SimulatedFault, APenThatLosesPowerDoesNotPushBeforeItIsHomedAgain) {
  Trial t;
  t.start();
  t.bench.pen->unplug();
  t.bench.run(0.2);
  t.bench.pen->restart();
  t.bench.pen->plug();
  t.bench.run(3);
  EXPECT_EQ(t.bench.loop.status().state, LinkState::Connected);
  EXPECT_FALSE(t.bench.step.last.homed);
  EXPECT_EQ(t.current, 0);
  t.bench.model.home();
  t.bench.step.safety.reset();
  t.comes_back();
}

TEST(SimulatedFault, APenThatRestartsWithoutBeingUnpluggedDoesNotPush) {
  Trial t;
  t.start();
  t.bench.pen->restart();
  t.goes_dead(3e-4, 0.5);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 0);
}

/// --- The step. ---------------------------------------------------------------------------------------------------
/// ///

TEST(SimulatedFault, AStepThatComputesNoNumberOrTooMuchPushesWithNothing) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInf = std::numeric_limits<double>::infinity();
  for (const Vec3& force : {Vec3(0, kNan, 0), Vec3(kInf, 0, 0), Vec3(0, 0, -1e6)}) {
    SCOPED_TRACE(force.x + force.z);
    Trial t;
    t.start();
    t.bench.step.law = [&](const PenSample&, double, double) { return Wrench{force, {}}; };
    t.goes_dead(kRound);
    EXPECT_TRUE(t.tripped_by(haptics::Cause::BadWrench) || t.tripped_by(haptics::Cause::Excess));
    t.bench.step.law = [&](const PenSample&, double, double) { return Wrench{{0, 0, t.newtons}, {}}; };
    t.bench.step.safety.reset();
    t.comes_back();
  }
}

/// The host is stopped as at the end of a session: the pen's motors are off one frame later.
TEST(SimulatedFault, StoppingTheDriverSwitchesTheMotorsOff) {
  Trial t;
  t.start();
  t.bench.loop.stop();
  t.bench.run_alone(0.1);
  EXPECT_LE(t.last_pushed, t.injected + 1.3e-3);
  EXPECT_EQ(t.bench.pen->firmware().state, RIFFLER_PEN_IDLE);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 0);
}

}  // namespace
}  // namespace riffler::pen::simulated_link_faults_test
