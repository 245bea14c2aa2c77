// Limits that keep the direction, the rate limit and the model of the windings' heat.
#include <gtest/gtest.h>

#include <cmath>

#include "device/pens.hpp"

namespace riffler::device::currents_test {
namespace {

using Limits = std::array<std::uint16_t, RIFFLER_PEN_JOINTS>;

TEST(PenCurrents, WithinTheLimitsNothingChanges) {
  const Limits limits = {1500, 1500, 1500, 10, 1, 32767};
  Currents currents = {1500, -1500, 0, 10, -1, 32767};
  const Currents before = currents;
  EXPECT_FALSE(riffler_pen_limit_currents(currents.data(), limits.data()));
  EXPECT_EQ(currents, before);
}

TEST(PenCurrents, TheCurrentThatExceedsItsLimitMostScalesAll) {
  const Limits limits = {1000, 1000, 1000, 100, 1000, 1000};
  Currents currents = {2000, -1000, 500, 400, 0, 4};
  EXPECT_TRUE(riffler_pen_limit_currents(currents.data(), limits.data()));
  EXPECT_EQ(currents, (Currents{500, -250, 125, 100, 0, 1}));
}

TEST(PenCurrents, AnyCommandKeepsItsDirectionWithinItsLimits) {
  stress::Random random(21);
  for (int round = 0; round < 200'000; ++round) {
    Limits limits;
    Currents currents;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
      limits[k] = static_cast<std::uint16_t>(std::round(random.power_of_ten(0, 4.515)));
      currents[k] = static_cast<std::int16_t>(random.one_in(8) ? (random.one_in(2) ? INT16_MIN : 0) : random.bits());
    }
    const Currents asked = currents;
    const bool limited = riffler_pen_limit_currents(currents.data(), limits.data());
    double factor = 1;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k)
      if (asked[k] != 0) factor = std::min(factor, limits[k] / std::abs(static_cast<double>(asked[k])));
    ASSERT_EQ(limited, factor < 1);
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
      ASSERT_LE(std::abs(currents[k]), limits[k]);
      ASSERT_NEAR(currents[k], asked[k] * factor, 1);
      ASSERT_LE(std::abs(currents[k]), std::abs(asked[k]));
      ASSERT_GE(currents[k] * asked[k], 0);
    }
  }
}

TEST(PenCurrents, ChangeOnAStraightLineAndNotTooFast) {
  stress::Random random(22);
  for (int round = 0; round < 20'000; ++round) {
    Currents from, to;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
      from[k] = static_cast<std::int16_t>(random.bits());
      to[k] = static_cast<std::int16_t>(random.bits());
    }
    const Currents start = from;
    const int most = random.below(70'000);
    double farthest = 0;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) farthest = std::max(farthest, std::abs(1.0 * to[k] - start[k]));
    const double part = farthest <= most ? 1 : most / farthest;
    ASSERT_EQ(riffler_pen_approach(from.data(), to.data(), most), part < 1);
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
      ASSERT_LE(std::abs(from[k] - start[k]), most);
      ASSERT_NEAR(from[k], start[k] + part * (to[k] - start[k]), 1);
    }
  }
}

TEST(PenCurrents, ShortStepsReachTheRateOfLongOnes) {
  riffler_pen_config config = reference();
  config.limits.rate_ma_per_ms = 3;  // 0.375 mA in 125 µs
  for (const std::uint32_t tick : {125U, 300U, 1000U, 4000U}) {
    Pen pen(config);
    pen.activate();
    for (std::uint32_t time = 0; time < 240'000; time += tick) pen.turn(true, {0, 1000, 0, 0, 0, 0}, tick);
    EXPECT_NEAR(pen.currents()[1], 3 * 240, 1 + 3.0 * tick / 1000) << tick;
    EXPECT_TRUE(pen.pen.flags & RIFFLER_PEN_FLAG_RATE_LIMITED);
  }
}

/// Heat of the first motor, mA².
double heat(const Pen& pen) {
  return static_cast<double>(pen.pen.heat_q12[0]) / 4096;
}

/// The same first-order model in real numbers.
double heat_after(double seconds, double current, double constant) {
  return current * current * (1 - std::exp(-seconds / constant));
}

TEST(PenCurrents, HeatFollowsTheSquareOfTheCurrentWithTheWindingsTime) {
  for (const std::uint32_t tick : {125U, 1000U, 3000U}) {
    riffler_pen_config config = reference();
    config.limits.thermal_ms = 4000;
    config.limits.continuous_ma[0] = 1500;  // no fold-back
    Pen pen(config);
    pen.activate();
    double time = 0;
    for (; time < 3; time += 1e-6 * tick) pen.turn(true, {700, 0, 0, 0, 0, 0}, tick);
    EXPECT_NEAR(heat(pen), heat_after(time - 0.007, 700, 4), 0.004 * 700 * 700) << tick;
    EXPECT_EQ(pen.pen.heat_q12[1], 0);
    EXPECT_FALSE(pen.pen.flags & RIFFLER_PEN_FLAG_FOLDBACK);
  }
}

TEST(PenCurrents, HeatIsThatOfTheGreaterOfMeasuredAndCommandedCurrent) {
  riffler_pen_config config = reference();
  config.limits.thermal_ms = 1000;
  config.mismatch_ma = 1000;
  Pen pen(config);
  pen.activate({400, 400, 0, 0, 0, 0});
  for (int ms = 0; ms < 8000; ++ms) {
    pen.send(true, {400, 400, 0, 0, 0, 0});
    for (std::int32_t& counter : pen.sensors.counters) counter = moved(counter, ms % 2 ? 1 : -1);
    pen.sensors.current_ma[0] = -450;
    pen.sensors.current_ma[1] = 0;  // a sensor that is dead
    pen.drive = riffler_pen_step(&pen.pen, &pen.sensors, 1000);
  }
  EXPECT_NEAR(std::sqrt(heat(pen)), 450, 2);
  EXPECT_NEAR(std::sqrt(static_cast<double>(pen.pen.heat_q12[1]) / 4096), 400, 2);
}

TEST(PenCurrents, TheLimitFallsFromHalfOfTheHeatOnAStraightLine) {
  const double full = 500.0 * 500 * 4096;
  for (const auto& [part, limit] :
       {std::pair{0.5, 1500}, {0.6, 1300}, {0.75, 1000}, {0.9, 700}, {1.0, 500}, {1.5, 500}}) {
    riffler_pen_config config = reference();
    config.limits.thermal_ms = 65535;
    config.limits.rate_ma_per_ms = 65535;
    Pen pen(config);
    pen.activate();
    pen.pen.heat_q12[0] = static_cast<std::int64_t>(part * full);
    pen.turn(true, {1500, 0, 0, 0, 0, 0});
    EXPECT_NEAR(pen.currents()[0], limit, 1) << part;
  }
}

TEST(PenCurrents, AWarmMotorGetsItsContinuousCurrentAndTheOthersLessInProportion) {
  riffler_pen_config config = reference();
  config.limits.thermal_ms = 1000;
  Pen pen(config);
  pen.activate();
  std::int16_t last = 0;
  bool folds = false;
  for (int ms = 0; ms < 8000; ++ms) {
    pen.turn(true, {1500, -750, 0, 0, 0, 0});
    if (ms > 20) {
      ASSERT_LE(pen.currents()[0], last) << "the limit falls and stays, it does not hunt";
      ASSERT_NEAR(pen.currents()[1], -pen.currents()[0] / 2.0, 1);
    }
    folds |= bool(pen.pen.flags & RIFFLER_PEN_FLAG_FOLDBACK);
    last = pen.currents()[0];
  }
  EXPECT_TRUE(folds);
  EXPECT_NEAR(pen.currents()[0], 500, 5);
  EXPECT_NEAR(std::sqrt(heat(pen)), 500, 5) << "the winding is as warm as it may be, and no warmer";
  for (int ms = 0; ms < 8000; ++ms) pen.turn(true, {});
  pen.turn(true, {1500, 0, 0, 0, 0, 0});
  EXPECT_FALSE(pen.pen.flags & RIFFLER_PEN_FLAG_FOLDBACK) << "cold again";
}

TEST(PenCurrents, AWindingCoolsWhileThePenIsDisabled) {
  riffler_pen_config config = reference();
  config.limits.thermal_ms = 1000;
  Pen pen(config);
  pen.activate();
  for (int ms = 0; ms < 3000; ++ms) pen.turn(true, {1500, 0, 0, 0, 0, 0});
  const double warm = static_cast<double>(pen.pen.heat_q12[0]);
  for (int ms = 0; ms < 1000; ++ms) pen.turn(false);
  EXPECT_NEAR(static_cast<double>(pen.pen.heat_q12[0]), warm / std::exp(1), 0.01 * warm);
}

}  // namespace
}  // namespace riffler::device::currents_test
