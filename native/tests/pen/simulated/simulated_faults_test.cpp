// Faults of motors, encoders and geometry: injected on the whole stack, found by the firmware or by the host.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "pen/simulated/simulated_trial.hpp"

namespace riffler::pen::simulated_faults_test {
namespace {

using test::hand_to_and_fro;
using test::home_pose;
using test::kRound;
using test::Trial;
using test::with;

/// --- The firmware finds it: force is zero in the turn that does, without the host. -------------------------------
/// ///

struct BoardFault {
  const char* name;
  riffler_pen_fault fault;
  void (*falsify)(riffler_pen_sensors&);
  double within;  // s
};

class SimulatedBoardFault : public ::testing::TestWithParam<BoardFault> {};

TEST_P(SimulatedBoardFault, RemovesTheForceWhichReturnsThroughTheRamp) {
  const BoardFault& param = GetParam();
  Trial t;
  t.start();
  t.falsify(param.falsify);
  t.goes_dead(param.within);
  EXPECT_EQ(t.bench.pen->firmware().fault, param.fault);
  EXPECT_EQ(t.bench.step.last.fault, param.fault);
  EXPECT_TRUE(t.tripped_by(haptics::Cause::DeviceFault));
  t.mend();
  t.bench.run(0.5);
  EXPECT_EQ(t.current, 0);  // until the trip is cleared
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
  // The firmware continues from the new count; the host sees two ends too far apart, which does not heal by itself.
  t.mend();
  t.bench.run(2);
  EXPECT_EQ(t.bench.step.safety.state(), haptics::ForceState::Tripped);
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
  EXPECT_EQ(t.cause(), haptics::Cause::Redundancy);
  t.mend();
  t.bench.run(1);
  EXPECT_EQ(t.current, 0);  // until the trip is cleared
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
  EXPECT_TRUE(t.tripped_by(haptics::Cause::Redundancy) || t.tripped_by(haptics::Cause::DeviceFault));
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
  // Eased to nothing within half a second, and a fault a tenth later.
  t.goes_dead(1e-3 * t.bench.pen->config().limits.stall_ms + 0.502, 2.7);
  EXPECT_EQ(t.faults, std::set<int>{RIFFLER_PEN_STALL});
  t.mend();
  t.comes_back();
}

/// Without a tremor, in all directions: there the firmware's question is answered, and the force stays what it was but
/// for its breathing.
TEST(SimulatedFault, AQuietHandThatLeansOnAForceIsNoFault) {
  int eased = 0;
  for (int k = 0; k < 27; ++k) {
    const Vec3 direction(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    const double square = glm::dot(direction, direction);
    if (square != 1 && square != 3) continue;  // along the axes and the diagonals of space
    SCOPED_TRACE(k);
    Trial t(hand_at(home_pose()), with([](SimulatedPenSettings& s) { s.hand.tremor = 0; }));
    t.bench.step.law = [&](const PenSample&, double, double) { return Wrench{1.5 * glm::normalize(direction), {}}; };
    t.start();
    double least = 1e300;
    t.bench.step.after = [&](const Wrench&) {
      least = std::min(least, t.current);
      eased += (t.bench.pen->firmware().flags & RIFFLER_PEN_FLAG_LIMITED) != 0;
    };
    t.bench.run(6);
    EXPECT_TRUE(t.faults.empty());
    EXPECT_EQ(t.bench.step.safety.log().count(), 0U);
    EXPECT_GT(least, 0.3 * t.full);
  }
  EXPECT_GT(eased, 1000) << "and it was asked";
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
  EXPECT_EQ(t.cause(), haptics::Cause::Redundancy);
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
  EXPECT_EQ(t.cause(), haptics::Cause::Redundancy);
}

}  // namespace
}  // namespace riffler::pen::simulated_faults_test
