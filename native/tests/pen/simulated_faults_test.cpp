// Faults on the whole stack: firmware, cable, codec, model, driver's loop and gate, with a hand on a simulated pen.
// Each is injected while the pen pushes, must take the force away within its time, and after it is gone the force comes
// back by the ramp. The loop runs on all the while: every wait is virtual, so a dead lock would be a test without end.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "pen/pens.hpp"
#include "pen/simulated_bench.hpp"

namespace riffler {
namespace {

using test::SimulatedBench;

constexpr double kWatchdog = 0.0203;  // s: the firmware's, and a turn of its loop
// s: from what the encoders read to motors without current, where the host finds the fault: a report, a tick that takes
// the force away, the answer's frame and a turn, and 4 ms of the firmware's 100 mA/ms.
constexpr double kRound = 0.0075;

SimulatedPenSettings with(const std::function<void(SimulatedPenSettings&)>& change) {
  SimulatedPenSettings settings;
  change(settings);
  return settings;
}

/// A bench that pushes with 0.7 N upward, 350 mA of the 400 from which a joint without a count is a stall, and what
/// its motors did.
struct Trial {
  explicit Trial(HandPath path = nullptr, const SimulatedPenSettings& settings = {})
      : bench(settings, std::move(path)) {
    bench.step.law = [this](const PenSample&, double, double) { return Wrench{{0, 0, newtons}, {}}; };
    bench.pen->on_turn = [this] {
      if (bench.pen->firmware().fault != 0) faults.insert(bench.pen->firmware().fault);
      double most = 0;
      for (const std::int16_t c : bench.pen->drive().current_ma)
        if (bench.pen->drive().power) most = std::max(most, std::abs(static_cast<double>(c)));
      const double now = 1e-6 * static_cast<double>(bench.pen->time_us());
      if (most > 0) last_pushed = now;
      if (most == 0) risen_from = now;
      // Of a ramp of half a second a share of the time has passed, in two gates one after the other.
      steepest = std::max(steepest, most - full * std::min(1.0, (now - risen_from) / 0.4));
      current = most;
    };
  }
  /// Pushing at full for at least a second.
  void start() {
    bench.run(2);
    EXPECT_EQ(bench.pen->firmware().state, RIFFLER_PEN_ACTIVE);
    EXPECT_EQ(bench.step.safety.state(), ForceState::Active);
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
  /// The fault is gone: force comes back by the ramp, to what it was; after what does not heal by itself, once somebody
  /// has looked at it.
  void comes_back(double settles = 0.1) {
    bench.run(settles);
    steepest = 0;
    if (!heals(cause())) bench.step.safety.reset();
    bench.run(2.5);
    EXPECT_EQ(bench.loop.status().state, LinkState::Connected);
    EXPECT_EQ(bench.pen->firmware().state, RIFFLER_PEN_ACTIVE);
    EXPECT_EQ(bench.step.safety.state(), ForceState::Active) << sentence(cause());
    EXPECT_GT(current, 0.7 * full);
    EXPECT_LE(steepest, 0.05 * full) << "faster than the ramp";
    EXPECT_EQ(bench.step.pushed_while_tripped, 0);
  }
  Cause cause() const { return bench.step.safety.cause(); }
  bool tripped_by(Cause cause) {
    std::array<Trip, 64> trips{};
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

Pose home_pose() {
  return SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
}

/// Along a line, forth and back, `way` mm a second.
HandPath hand_to_and_fro(const Vec3& direction, double way) {
  return [home = home_pose(), direction, way](double t) {
    HandWish wish{.pose = home};
    wish.pose.tip += way / 3 * std::sin(3 * std::max(0.0, t - 1)) * direction;
    return wish;
  };
}

/// --- The firmware finds it: force is zero in the turn that does, without the host. -------------------------------
/// ///

struct BoardFault {
  const char* name;
  riffler_pen_fault fault;
  void (*falsify)(riffler_pen_sensors&);
  double within;  // s
};

class SimulatedBoardFault : public ::testing::TestWithParam<BoardFault> {};

TEST_P(SimulatedBoardFault, TakesTheForceAwayAndItComesBackByTheRamp) {
  const BoardFault& param = GetParam();
  Trial t;
  t.start();
  t.falsify(param.falsify);
  t.goes_dead(param.within);
  EXPECT_EQ(t.bench.pen->firmware().fault, param.fault);
  EXPECT_EQ(t.bench.step.last.fault, param.fault);
  EXPECT_TRUE(t.tripped_by(Cause::DeviceFault));
  t.mend();
  t.bench.run(0.5);
  EXPECT_EQ(t.current, 0);  // until somebody has looked at it
  t.bench.step.safety.reset();
  t.comes_back();
}

INSTANTIATE_TEST_SUITE_P(All, SimulatedBoardFault,
                         ::testing::Values(BoardFault{"EmergencyStop", RIFFLER_PEN_EMERGENCY_STOP,
                                                      [](riffler_pen_sensors& s) { s.stopped = 1; }, 3e-4},
                                           BoardFault{"MotorDriver", RIFFLER_PEN_DRIVER,
                                                      [](riffler_pen_sensors& s) { s.driver_faults = 4; }, 3e-4},
                                           BoardFault{"OverCurrent", RIFFLER_PEN_OVER_CURRENT,
                                                      [](riffler_pen_sensors& s) { s.current_ma[2] = -2600; }, 3e-4},
                                           BoardFault{"CurrentThatIsNotTheCommanded", RIFFLER_PEN_DRIVE_MISMATCH,
                                                      [](riffler_pen_sensors& s) { s.current_ma[4] = 1200; }, 0.0208},
                                           BoardFault{"OverTemperature", RIFFLER_PEN_OVER_TEMPERATURE,
                                                      [](riffler_pen_sensors& s) { s.temperature_dc[5] = 900; }, 3e-4},
                                           BoardFault{"BrokenTemperatureSensor", RIFFLER_PEN_TEMPERATURE_SENSOR,
                                                      [](riffler_pen_sensors& s) { s.temperature_dc[0] = 2000; }, 3e-4},
                                           BoardFault{"EncoderSignal", RIFFLER_PEN_ENCODER_SIGNAL,
                                                      [](riffler_pen_sensors& s) { s.encoder_errors = 2; }, 3e-4}),
                         [](const auto& param) { return std::string(param.param.name); });

TEST(SimulatedFault, ACounterThatJumpsFarIsFoundByTheFirmwareAndThePoseStaysInDoubt) {
  Trial t;
  t.start();
  t.falsify([](riffler_pen_sensors& s) { s.counters[1] += 5000; });
  t.goes_dead(3e-4);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 1);
  // The firmware goes on from the new count; the host sees two ends too far apart, which does not heal by itself.
  t.mend();
  t.bench.run(2);
  EXPECT_EQ(t.bench.step.safety.state(), ForceState::Tripped);
  EXPECT_EQ(t.current, 0);
  t.bench.step.safety.reset();
  t.comes_back();
}

TEST(SimulatedFault, ACounterThatJumpsALittleIsFoundByTheHost) {
  Trial t;
  t.start();
  t.falsify([](riffler_pen_sensors& s) { s.counters[1] += 60; });
  t.goes_dead(kRound);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 0);
  EXPECT_EQ(t.cause(), Cause::Redundancy);
  t.mend();
  t.bench.run(1);
  EXPECT_EQ(t.current, 0);  // until somebody says that it is right again
  t.bench.step.safety.reset();
  t.comes_back();
}

TEST(SimulatedFault, AFrozenCounterIsFoundAsSoonAsTheGripDoesNotFit) {
  Trial t(hand_to_and_fro({0, 0, 1}, 30));
  t.start();
  std::optional<std::int32_t> frozen;
  t.falsify([&frozen](riffler_pen_sensors& s) {
    if (!frozen) frozen = s.counters[1];
    s.counters[1] = *frozen;
  });
  double misfit = 0;  // when the host could know
  t.bench.step.after = [&](const Wrench&) {
    if (misfit == 0 && std::abs(t.bench.step.last.stretch) > 0.5) misfit = t.bench.now();
  };
  t.bench.run(1);
  ASSERT_GT(misfit, t.injected);
  EXPECT_LE(t.last_pushed, misfit + kRound);
  EXPECT_TRUE(t.tripped_by(Cause::Redundancy) || t.tripped_by(Cause::DeviceFault));
  t.mend();
  t.bench.run(0.5);
  t.bench.step.safety.reset();
  t.comes_back();
}

TEST(SimulatedFault, AllCountersFrozenUnderForceAreAStall) {
  Trial t(hand_to_and_fro({0, 0, 1}, 30));
  t.newtons = 1;
  t.start();
  std::optional<riffler_pen_sensors> frozen;
  t.falsify([&frozen](riffler_pen_sensors& s) {
    if (!frozen) frozen = s;
    std::copy_n(frozen->counters, RIFFLER_PEN_JOINTS, s.counters);
  });
  EXPECT_GE(t.current, t.bench.pen->config().limits.stall_ma);
  t.goes_dead(1e-3 * t.bench.pen->config().limits.stall_ms + 1e-3, 2.2);
  EXPECT_EQ(t.faults, std::set<int>{RIFFLER_PEN_STALL});
  t.mend();
  t.comes_back();
}

TEST(SimulatedFault, SwappedArmsAreFoundWhenThePenMovesAndNotPushedOn) {
  Trial t(hand_to_and_fro(glm::normalize(Vec3(1, 0.3, 0.5)), 60));
  t.falsify([](riffler_pen_sensors& s) { std::swap_ranges(s.counters, s.counters + 3, s.counters + 3); });
  double misfit = 0;
  t.bench.step.after = [&](const Wrench&) {
    if (misfit == 0 && std::abs(t.bench.step.last.stretch) > 0.5) misfit = t.bench.now();
  };
  t.bench.run(3);
  ASSERT_GT(misfit, 0.5);
  EXPECT_LT(misfit, 1.5);
  EXPECT_LE(t.last_pushed, misfit + kRound);
  EXPECT_EQ(t.cause(), Cause::Redundancy);
}

TEST(SimulatedFault, AGripOfAnotherLengthIsFoundWhenThePenMoves) {
  Trial t(hand_on_a_curve(home_pose()), with([](SimulatedPenSettings& s) { s.geometry.grip_length = 45; }));
  double misfit = 0;
  t.bench.step.after = [&](const Wrench&) {
    if (misfit == 0 && std::abs(t.bench.step.last.stretch) > 0.5) misfit = t.bench.now();
  };
  t.bench.run(5);
  ASSERT_GT(misfit, 1);
  EXPECT_LT(misfit, 2.5);
  EXPECT_LE(t.last_pushed, misfit + kRound);
  EXPECT_EQ(t.cause(), Cause::Redundancy);
}

/// --- Time: ticks that are late, hosts and processors that stand still. ------------------------------------------ ///

TEST(SimulatedFault, LateTicksFadeTheForceAndFromTheWatchdogOnTakeItAway) {
  for (const double late : {0.002, 0.005, 0.010, 0.015, 0.019, 0.0215, 0.030, 0.040}) {
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
      EXPECT_LE(t.last_pushed, t.injected + kWatchdog + 2e-3);  // two reports were on the way
      EXPECT_EQ(t.faults, std::set<int>{RIFFLER_PEN_WATCHDOG});
      EXPECT_TRUE(t.tripped_by(Cause::DeviceFault));  // the pen's word comes before the host's own finding
    } else if (late > 0.003) {
      EXPECT_LT(least, t.newtons * (1.01 - (late - 0.003) / 0.017));
      EXPECT_EQ(t.bench.pen->firmware().fault_count, 0);
    } else {
      EXPECT_GT(least, 0.99 * t.newtons);
    }
    t.comes_back();
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
  EXPECT_TRUE(t.tripped_by(Cause::DeviceFault));
  t.bench.step.law = [&](const PenSample&, double, double) { return Wrench{{0, 0, t.newtons}, {}}; };
  t.comes_back();
}

TEST(SimulatedFault, AHostThatDiesIsMissedWithinTheWatchdogsTime) {
  Trial t;
  t.start();
  t.bench.run_alone(0.5);
  EXPECT_LE(t.last_pushed, t.injected + kWatchdog + 2e-3);
  EXPECT_GE(t.last_pushed, t.injected + 0.015);  // and not much before
  EXPECT_EQ(t.bench.pen->firmware().fault, RIFFLER_PEN_WATCHDOG);
  EXPECT_EQ(t.current, 0);
  t.comes_back();
}

TEST(SimulatedFault, AProcessorThatStandsStillIsSwitchedOffByTheBoard) {
  Trial t;
  t.start();
  t.bench.pen->halt(200'000);
  t.goes_dead(0.0105, 0.19);
  EXPECT_TRUE(t.tripped_by(Cause::Stale) || t.tripped_by(Cause::LateTick));
  t.bench.run(0.05);
  EXPECT_GT(t.bench.pen->firmware().fault_count, 0);  // late step
  t.comes_back();
}

TEST(SimulatedFault, AFirmwareThatIsLateWhileItPushesFindsItItself) {
  Trial t;
  t.start();
  t.bench.pen->halt(7'000);
  t.goes_dead(0.0075, 0.1);
  EXPECT_EQ(t.bench.pen->firmware().fault_count, 1);
  t.comes_back();
}

/// --- The cable. --------------------------------------------------------------------------------------------------
/// ///

TEST(SimulatedFault, AllReportsLostOnTheWayToTheHost) {
  Trial t;
  t.start();
  t.bench.pen->cable().set({.lost = 1});
  t.goes_dead(0.020 + kRound, 0.2);
  EXPECT_TRUE(t.tripped_by(Cause::Stale) || t.tripped_by(Cause::LateTick));
  t.bench.run(0.3);  // silent for longer than the driver waits: closed, and looked for
  EXPECT_EQ(t.bench.loop.status().counts.silences, 1U);
  t.bench.pen->cable().set({});
  t.comes_back();
}

TEST(SimulatedFault, AllReportsLostOnTheWayToThePen) {
  Trial t;
  t.start();
  t.bench.pen->cable().set({.lost_out = 1});
  t.goes_dead(kWatchdog + 2e-3);
  EXPECT_TRUE(t.tripped_by(Cause::DeviceFault));
  t.bench.pen->cable().set({});
  t.comes_back();
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
    EXPECT_TRUE(t.tripped_by(Cause::BadWrench) || t.tripped_by(Cause::Excess));
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
}  // namespace riffler
