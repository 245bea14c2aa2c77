// The firmware in good days: from boot to force and back, with the watchdog's and the ramp's times kept to the step.
#include <gtest/gtest.h>

#include <cmath>

#include "device/pens.hpp"

namespace riffler::device::firmware_test {
namespace {

const Currents kCommand = {300, -600, 900, 0, 15, -1200};

TEST(PenFirmware, WaitsForItsSensorsThenForAReportThatDisables) {
  Pen pen;
  pen.sensors.ready = 0;
  for (int k = 0; k < 10; ++k) {
    pen.turn(k % 2 == 0, kCommand);
    EXPECT_EQ(pen.state(), RIFFLER_PEN_BOOT);
  }
  pen.sensors.ready = 1;
  pen.turn(true, kCommand);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
  for (int k = 0; k < 100; ++k) {
    pen.turn(true, kCommand);
    ASSERT_EQ(pen.state(), RIFFLER_PEN_IDLE) << "a host that enables from the start is not one that means it";
    ASSERT_FALSE(pen.pen.flags & RIFFLER_PEN_FLAG_ARMED);
  }
  pen.turn(false);
  EXPECT_TRUE(pen.pen.flags & RIFFLER_PEN_FLAG_ARMED);
  EXPECT_FALSE(pen.drive.power);
  pen.turn(true, kCommand);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_RAMP);
  EXPECT_TRUE(pen.drive.power);
  EXPECT_FALSE(pen.drive.brake);
  EXPECT_EQ(pen.currents(), Currents{}) << "the ramp begins at nothing";
}

TEST(PenFirmware, ReadySensorsAreCheckedOnlyOnce) {
  Pen pen;
  pen.activate();
  pen.sensors.ready = 0;
  pen.turn(true);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
}

TEST(PenFirmware, TheRampTakesItsTimeAndForceNeverFalls) {
  Pen pen;
  pen.step();
  pen.turn(false);
  pen.turn(true, kCommand);
  Currents last{};
  for (int ms = 1; ms < 500; ++ms) {
    pen.turn(true, kCommand);
    ASSERT_EQ(pen.state(), RIFFLER_PEN_RAMP) << ms;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
      ASSERT_GE(std::abs(pen.currents()[k]), std::abs(last[k]));
      // The line from nothing to the command, to the mA.
      ASSERT_NEAR(pen.currents()[k], kCommand[k] * ms / 500.0, 1);
    }
    last = pen.currents();
  }
  pen.turn(true, kCommand);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_ACTIVE) << "after 500 ms to the step";
  EXPECT_EQ(pen.currents(), kCommand);
}

TEST(PenFirmware, TheRampScalesTheLimitedCommand) {
  Pen pen;
  pen.step();
  pen.turn(false);
  for (int ms = 0; ms <= 250; ++ms) pen.turn(true, {15000, 0, 0, 0, 0, 0});
  EXPECT_EQ(pen.currents()[0], 750) << "half of the peak after half of the ramp";
}

TEST(PenFirmware, ADisableRemovesForceAtOnceFromRampAndFromActive) {
  Pen pen;
  pen.step();
  pen.turn(false);
  for (int k = 0; k < 100; ++k) pen.turn(true, kCommand);
  ASSERT_EQ(pen.state(), RIFFLER_PEN_RAMP);
  ASSERT_NE(pen.currents(), Currents{});
  pen.turn(false, kCommand);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
  EXPECT_EQ(pen.currents(), Currents{});
  EXPECT_FALSE(pen.drive.power);
  EXPECT_FALSE(pen.drive.brake) << "a pen at rest moves freely";
  pen.activate(kCommand);
  ASSERT_EQ(pen.currents(), kCommand);
  pen.turn(false, kCommand);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
  EXPECT_EQ(pen.currents(), Currents{});
  pen.turn(true, kCommand);
  EXPECT_EQ(pen.state(), RIFFLER_PEN_RAMP) << "and begins again with a ramp";
  EXPECT_EQ(pen.currents(), Currents{});
}

TEST(PenFirmware, ADisableBetweenTwoStepsIsNotMissed) {
  Pen pen;
  pen.activate(kCommand);
  pen.send(false);
  pen.send(true, kCommand);
  pen.step();
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
  EXPECT_EQ(pen.currents(), Currents{});
}

TEST(PenFirmware, TheWatchdogTripsAtItsStepAndNotBefore) {
  for (const std::uint32_t tick : {125U, 250U, 1000U, 5000U}) {
    Pen pen;
    pen.activate(kCommand);
    pen.turn(true, kCommand, tick);
    const std::uint32_t steps = 20'000 / tick;
    for (std::uint32_t k = 1; k < steps; ++k) {
      pen.step(tick);
      ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE) << k * tick << " µs";
    }
    pen.step(tick);
    EXPECT_EQ(pen.state(), RIFFLER_PEN_FAULT) << tick;
    EXPECT_EQ(pen.fault(), RIFFLER_PEN_WATCHDOG);
    EXPECT_EQ(pen.currents(), Currents{});
    EXPECT_TRUE(pen.drive.brake);
    EXPECT_FALSE(pen.drive.power);
  }
}

TEST(PenFirmware, AStaleCommandDecaysOnAStraightLineToTheWatchdogsTime) {
  riffler_pen_config config = reference();
  config.limits.rate_ma_per_ms = 65535;
  Pen pen(config);
  pen.activate({0, 0, 1500, 0, 0, -500});
  pen.turn(true, {0, 0, 1500, 0, 0, -500});
  const int peak = pen.currents()[2];
  ASSERT_GT(peak, 1400);
  for (int age = 1; age < 20; ++age) {
    pen.step();
    const double part = age <= 5 ? 1 : (20.0 - age) / 15;
    ASSERT_NEAR(pen.currents()[2], 1500 * part, 2 + 1500 - peak) << age;
    ASSERT_NEAR(pen.currents()[5], -500 * part, 2) << age;
    ASSERT_EQ(bool(pen.pen.flags & RIFFLER_PEN_FLAG_STALE), age > 5) << age;
  }
}

TEST(PenFirmware, AReportFromTimeToTimeIsEnough) {
  Pen pen;
  pen.activate(kCommand);
  for (int k = 0; k < 1000; ++k) {
    if (k % 19 == 0) pen.send(true, kCommand);
    pen.step();
    ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
  }
}

TEST(PenFirmware, SequenceAndTimesWrapWithoutEffect) {
  Pen pen;
  pen.sequence = 0xFF00;
  pen.pen.sequence = 0xFF00;
  pen.pen.time_us = 0xFFFFFFFFU - 300'000;
  for (std::int32_t& counter : pen.sensors.counters) counter = INT32_MAX - 1;
  pen.activate(kCommand);
  std::uint16_t sequence = riffler_pen_report(&pen.pen).sequence;
  std::uint32_t time = pen.pen.time_us;
  for (int k = 0; k < 1000; ++k) {
    for (std::int32_t& counter : pen.sensors.counters) counter = moved(counter, 10);
    pen.send(true, kCommand);
    pen.still_step();
    ASSERT_EQ(pen.state(), RIFFLER_PEN_ACTIVE);
    const riffler_pen_input report = riffler_pen_report(&pen.pen);
    ASSERT_EQ(report.sequence, static_cast<std::uint16_t>(sequence + 1));
    ASSERT_EQ(report.time_us, time + 1000);
    sequence = report.sequence;
    time = report.time_us;
  }
  EXPECT_LT(pen.sequence, 0xFF00);
  EXPECT_LT(pen.sensors.counters[0], 0);
}

TEST(PenFirmware, ReportsItsStateToTheHost) {
  Pen pen;
  pen.activate(kCommand);
  pen.sensors.buttons = 0x0102;
  pen.sensors.probe = -77;
  riffler_pen_output output{};
  output.enable = 1;
  output.sequence = pen.sequence = static_cast<std::uint16_t>(pen.sequence + 5);
  output.time_us = 0xDEADBEEF;
  for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) output.commands[k] = kCommand[k];
  const Bytes bytes = encoded(output);
  riffler_pen_receive(&pen.pen, bytes.data(), bytes.size());
  riffler_pen_receive(&pen.pen, bytes.data(), bytes.size());  // the same again
  pen.step();
  const riffler_pen_input report = riffler_pen_report(&pen.pen);
  EXPECT_EQ(report.state, RIFFLER_PEN_ACTIVE);
  EXPECT_EQ(report.fault, RIFFLER_PEN_NO_FAULT);
  EXPECT_EQ(report.fault_joint, RIFFLER_PEN_NO_JOINT);
  EXPECT_EQ(report.flags & RIFFLER_PEN_FLAG_HOST, RIFFLER_PEN_FLAG_HOST);
  EXPECT_EQ(report.buttons, 0x0102);
  EXPECT_EQ(report.probe, -77);
  EXPECT_EQ(report.echo_sequence, pen.sequence);
  EXPECT_EQ(report.echo_time_us, 0xDEADBEEFU);
  EXPECT_EQ(report.refused_count, 1);
  for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    EXPECT_EQ(report.counters[k], pen.sensors.counters[k]);
    EXPECT_EQ(report.applied[k], kCommand[k]);
  }
  riffler_pen_input back{};
  EXPECT_EQ(decode(encoded(report), back), RIFFLER_PEN_OK);
}

TEST(PenFirmware, AHostMayBeginAtAnyNumberButNotGoBack) {
  Pen pen;
  pen.sequence = 40'000;
  pen.activate();
  pen.sequence = 39'000;
  EXPECT_EQ(pen.send(true), RIFFLER_PEN_OLD_SEQUENCE);
  pen.sequence = 60'000;
  EXPECT_EQ(pen.send(true), RIFFLER_PEN_OK) << "lost reports are no reason to stop";
  pen.turn(false);
  for (int k = 0; k < 20; ++k) pen.step();
  EXPECT_FALSE(pen.pen.flags & RIFFLER_PEN_FLAG_HOST);
  EXPECT_FALSE(pen.pen.flags & RIFFLER_PEN_FLAG_ARMED) << "the host that disabled is gone";
  pen.sequence = 0;
  EXPECT_EQ(pen.send(true), RIFFLER_PEN_OK) << "a host that was gone may be another";
  pen.step();
  EXPECT_EQ(pen.state(), RIFFLER_PEN_IDLE);
}

TEST(PenFirmware, FeatureReportsAreThoseOfItsConfiguration) {
  const riffler_pen_config config = reference();
  ASSERT_EQ(riffler_pen_config_problem(&config), nullptr);
  Bytes bytes(RIFFLER_PEN_PACKET_SIZE);
  ASSERT_EQ(riffler_pen_feature(&config, RIFFLER_PEN_IDENTITY_ID, bytes.data(), bytes.size()),
            std::size_t{RIFFLER_PEN_IDENTITY_SIZE});
  riffler_pen_identity identity{};
  EXPECT_EQ(riffler_pen_decode_identity(bytes.data(), RIFFLER_PEN_IDENTITY_SIZE, &identity), RIFFLER_PEN_OK);
  EXPECT_STREQ(identity.geometry, config.identity.geometry);
  ASSERT_EQ(riffler_pen_feature(&config, RIFFLER_PEN_LIMITS_ID, bytes.data(), bytes.size()),
            std::size_t{RIFFLER_PEN_LIMITS_SIZE});
  riffler_pen_limits limits{};
  EXPECT_EQ(riffler_pen_decode_limits(bytes.data(), RIFFLER_PEN_LIMITS_SIZE, &limits), RIFFLER_PEN_OK);
  EXPECT_EQ(limits.watchdog_us, config.limits.watchdog_us);
  for (int id = 0; id < 256; ++id) {
    const bool is_feature = id == RIFFLER_PEN_IDENTITY_ID || id == RIFFLER_PEN_LIMITS_ID;
    EXPECT_EQ(riffler_pen_feature(&config, static_cast<std::uint8_t>(id), bytes.data(), bytes.size()) > 0, is_feature);
  }
  EXPECT_EQ(riffler_pen_feature(&config, RIFFLER_PEN_IDENTITY_ID, bytes.data(), RIFFLER_PEN_IDENTITY_SIZE - 1), 0U);
  EXPECT_EQ(riffler_pen_feature(&config, RIFFLER_PEN_LIMITS_ID, bytes.data(), RIFFLER_PEN_LIMITS_SIZE - 1), 0U);
}

TEST(PenFirmware, AConfigurationThatMakesNoSenseNeverPushes) {
  const auto expect = [](const char* what, const auto& spoil) {
    riffler_pen_config config = reference();
    spoil(config);
    const char* const problem = riffler_pen_config_problem(&config);
    ASSERT_NE(problem, nullptr) << what;
    EXPECT_NE(std::string(problem).find(what), std::string::npos) << problem;
    Pen pen(config);
    for (int k = 0; k < 100; ++k) {
      pen.turn(k % 3 == 2, kCommand);
      ASSERT_EQ(pen.state(), RIFFLER_PEN_FAULT);
      ASSERT_EQ(pen.fault(), RIFFLER_PEN_CONFIGURATION);
      ASSERT_EQ(pen.currents(), Currents{});
    }
  };
  expect("trip", [](auto& c) { c.trip_ma[3] = 1500; });
  expect("trip", [](auto& c) { c.trip_ma[3] = 40000; });
  expect("late", [](auto& c) { c.late_us = 0; });
  expect("late", [](auto& c) { c.late_us = 20'001; });
  expect("mismatch", [](auto& c) { c.mismatch_ma = 0; });
  expect("mismatch", [](auto& c) { c.mismatch_us = 0; });
  expect("temperature", [](auto& c) { c.hottest_dc = -1; });
  expect("temperature", [](auto& c) { c.hottest_dc = 1501; });
  expect("name", [](auto& c) { c.identity.geometry[0] = '\0'; });
  expect("version", [](auto& c) { c.identity.major = 2; });
  expect("ramp", [](auto& c) { c.limits.ramp_us = 0; });
  expect("thermal", [](auto& c) { c.limits.thermal_ms = 0; });
}

}  // namespace
}  // namespace riffler::device::firmware_test
