// The driver without its thread, on a virtual clock: every order of reports, errors and returns.
#include "pen/driver_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pen/fake_link.hpp"
#include "pen/models/riffler_model.hpp"
#include "stress/random.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::driver_loop_test {
namespace {

using test::ConstantPush;
using test::FakeConnector;
using test::FakeTransport;
using test::FirmwarePen;
using test::Report;
using test::VirtualClock;

/// A Riffler pen on the driver's loop, homed.
struct Bench {
  Bench() { model.home(); }
  VirtualClock clock;
  FirmwarePen pen{clock};
  FakeConnector connector{pen.device};
  ConstantPush push;
  std::unique_ptr<HidTransport> transport = std::make_unique<FakeTransport>(pen.device);
  RifflerModel model{*transport};
  DriverLoop loop{model, push, connector, clock, std::move(transport)};

  void run(double seconds) {
    const double end = clock.time + seconds;
    while (clock.time < end) loop.tick();
  }
  LinkCounts counts() const { return loop.status().counts; }
  riffler_pen_output last_output() const {
    riffler_pen_output report{};
    const Report& bytes = pen.device.written.back();
    EXPECT_EQ(riffler_pen_decode_output(bytes.data(), bytes.size(), &report), RIFFLER_PEN_OK);
    return report;
  }
};

Report input(std::uint16_t sequence) {
  riffler_pen_input report{};
  report.state = RIFFLER_PEN_IDLE;
  report.fault_joint = RIFFLER_PEN_NO_JOINT;
  report.sequence = sequence;
  report.time_us = 1000U * sequence;
  Report bytes(RIFFLER_PEN_INPUT_SIZE);
  riffler_pen_encode_input(&report, bytes.data());
  return bytes;
}

/// The same without a firmware: reports are written by the test.
struct Script : Bench {
  Script() {
    pen.device.on_read = [](double) {};
  }
  void send(Report bytes, double after = 0) { pen.device.send(clock.time + after, std::move(bytes)); }
};

TEST(DriverLoop, AnswersEveryReportWithOneCommand) {
  Bench b;
  b.run(1);
  EXPECT_NEAR(static_cast<double>(b.counts().reports), 1000, 2);
  EXPECT_EQ(b.counts().reports, static_cast<std::uint64_t>(b.push.steps));
  EXPECT_EQ(b.counts().writes, b.counts().reports + 1);  // and the one of the opening
  EXPECT_EQ(b.counts().superseded + b.counts().lost + b.counts().old + b.counts().malformed, 0);
  EXPECT_EQ(b.loop.status().state, LinkState::Connected);
  EXPECT_NEAR(b.push.last_dt, 1e-3, 1e-9);
}

TEST(DriverLoop, TheFirstCommandOfAConnectionIsNotToPush) {
  Bench b;
  ASSERT_EQ(b.pen.device.written.size(), 1U);
  EXPECT_EQ(b.last_output().enable, 0);
}

TEST(DriverLoop, OnlyTheNewestReportOfAQueueIsUsedForAStep) {
  Script b;
  for (std::uint16_t k = 1; k <= 50; ++k) b.send(input(k));
  b.loop.tick();
  EXPECT_EQ(b.push.steps, 1);
  EXPECT_EQ(b.push.last.sequence, 50U);
  EXPECT_EQ(b.counts().reports, 50U);
  EXPECT_EQ(b.counts().superseded, 49U);
  EXPECT_EQ(b.counts().lost, 0U);
}

TEST(DriverLoop, AllReportsOfAMergedReadAreUsed) {
  Script b;
  Report merged = input(1);
  for (std::uint16_t k = 2; k <= 5; ++k) {
    const Report next = input(k);
    merged.insert(merged.end(), next.begin(), next.end());
  }
  b.send(merged);
  b.loop.tick();
  EXPECT_EQ(b.counts().reports, 5U);
  EXPECT_EQ(b.counts().malformed, 0U);
  EXPECT_EQ(b.push.last.sequence, 5U);
}

TEST(DriverLoop, ShortAndForeignReportsAreCountedAndSkipped) {
  Script b;
  b.send(input(1));
  b.loop.tick();
  const PenSample before = b.push.last;
  Report cut = input(2), tail = input(3), foreign = input(4);
  cut.resize(17);
  tail.insert(tail.end(), cut.begin(), cut.end());
  foreign[0] = 9;
  b.send(cut);
  b.loop.tick();
  EXPECT_EQ(b.counts().malformed, 1U);
  EXPECT_EQ(b.push.last.sequence, before.sequence) << "the step runs on, with the old sample";
  EXPECT_EQ(b.push.last.time, before.time);
  b.send(tail), b.send(foreign);
  b.loop.tick();
  EXPECT_EQ(b.counts().malformed, 3U);
  EXPECT_EQ(b.push.last.sequence, 3U);
  EXPECT_EQ(b.counts().lost, 1U);
  EXPECT_EQ(b.loop.status().state, LinkState::Connected);
}

TEST(DriverLoop, TheSequenceOfReportsWraps) {
  Script b;
  std::uint16_t sequence = 65000;
  for (int k = 0; k < 2000; ++k) {
    b.send(input(sequence++));
    b.loop.tick();
  }
  EXPECT_EQ(b.push.last.sequence, 2000U);
  EXPECT_EQ(b.counts().lost + b.counts().old, 0U);
}

TEST(DriverLoop, LostAndRepeatedReportsAreReported) {
  Script b;
  for (const int k : {65533, 65534, 65534, 2, 1, 3}) {
    b.send(input(static_cast<std::uint16_t>(k)));
    b.loop.tick();
  }
  EXPECT_EQ(b.counts().reports, 4U);
  EXPECT_EQ(b.counts().lost, 3U);  // 65535, 0, 1: what comes too late is lost
  EXPECT_EQ(b.counts().old, 2U);
  EXPECT_EQ(b.push.last.sequence, 7U);
}

TEST(DriverLoop, StepsOnWithoutReportsUntilTheDeviceCountsAsGone) {
  Script b;
  b.send(input(1));
  b.loop.tick();
  const double heard = b.clock.time;
  b.loop.tick();
  EXPECT_EQ(b.push.steps, 2);
  EXPECT_NEAR(b.push.last_now - b.push.last.time, 0.01, 1e-9) << "the sample's age shows";
  while (b.loop.status().state == LinkState::Connected) b.loop.tick();
  EXPECT_NEAR(b.clock.time - heard, 0.25, 0.011);
  EXPECT_EQ(b.counts().silences, 1U);
  EXPECT_EQ(b.pen.device.open, 0);
  EXPECT_EQ(b.last_output().enable, 0);
}

TEST(DriverLoop, GarbageIsNoSignOfLife) {
  Script b;
  for (int k = 0; k < 100; ++k) b.send(Report(5, 0xFF), 5e-3 * k);
  while (b.loop.status().state == LinkState::Connected) b.loop.tick();
  EXPECT_EQ(b.counts().silences, 1U);
  EXPECT_EQ(b.counts().reports, 0U);
}

TEST(DriverLoop, AReadErrorRemovesTheForceAndClosesTheDevice) {
  Bench b;
  b.push.wrench.force = {0, 0, 1};
  b.run(3);
  ASSERT_TRUE(b.pen.pushes());
  EXPECT_EQ(b.loop.status().wrench.force, Vec3(0, 0, 1));
  b.connector.there = false;
  b.pen.device.gone = b.clock.time + 0.0005;
  b.loop.tick();
  const LinkStatus status = b.loop.status();
  EXPECT_EQ(status.state, LinkState::Waiting);
  EXPECT_EQ(status.counts.read_errors, 1U);
  EXPECT_EQ(status.wrench.force, Vec3(0));
  EXPECT_EQ(b.pen.device.open, 0);
}

TEST(DriverLoop, AFailedReadSendsZeroForceToADeviceThatStillListens) {
  Bench b;
  b.push.wrench.force = {0, 0, 1};
  b.run(3);
  ASSERT_EQ(b.last_output().enable, 1);
  b.pen.device.on_read = [](double) {};
  b.pen.device.events.clear();
  // Only reading fails: the script's end of the device is after this write.
  struct FailingRead final : Transport {
    explicit FailingRead(test::FakeDevice& d) : device(d) {}
    int read(std::span<std::uint8_t>, double) noexcept override { return -1; }
    bool write(std::span<const std::uint8_t> bytes) noexcept override {
      device.written.emplace_back(bytes.begin(), bytes.end());
      return true;
    }
    test::FakeDevice& device;
  };
  DriverLoop loop(b.model, b.push, b.connector, b.clock, std::make_unique<FailingRead>(b.pen.device));
  b.pen.device.written.clear();
  loop.tick();
  EXPECT_EQ(loop.status().counts.read_errors, 1U);
  ASSERT_EQ(b.pen.device.written.size(), 1U);
  EXPECT_EQ(b.last_output().enable, 0);
}

TEST(DriverLoop, AWriteErrorRemovesTheForceAndClosesTheDevice) {
  Bench b;
  b.run(0.1);
  b.connector.there = false;
  b.pen.device.deaf = true;
  b.loop.tick();
  EXPECT_EQ(b.counts().write_errors, 1U);
  EXPECT_EQ(b.loop.status().state, LinkState::Waiting);
  EXPECT_EQ(b.pen.device.open, 0);
}

TEST(DriverLoop, LooksForALostDeviceEverLessOften) {
  Bench b;
  b.run(0.1);
  b.connector.there = false;
  b.pen.device.gone = b.clock.time;
  b.loop.tick();
  ASSERT_EQ(b.loop.status().state, LinkState::Waiting);
  double last = b.clock.time;
  b.run(12);
  EXPECT_EQ(b.loop.status().problem, OpenProblem::NoFile);
  ASSERT_GE(b.connector.asked.size(), 8U);
  double wait = 0.1;
  for (const double asked : b.connector.asked) {
    EXPECT_NEAR(asked - last, wait, 0.0101) << "attempt at " << asked;
    last = asked;
    wait = std::min(2 * wait, 2.0);
  }
}

TEST(DriverLoop, ContinuesWhenTheDeviceIsPluggedInAgain) {
  Bench b;
  b.push.wrench.force = {0, 0, 1};
  b.run(3);
  ASSERT_TRUE(b.pen.pushes());
  b.connector.there = false;
  b.pen.device.gone = b.clock.time;
  b.run(1);
  EXPECT_EQ(b.loop.status().state == LinkState::Connected, false);
  // Another life: counters and clock of the pen start from zero.
  b.pen.device.gone = 1e300;
  b.pen.device.events.clear();
  b.pen.power_on();
  b.connector.there = true;
  const std::uint64_t before = b.counts().reports;
  b.run(3);
  EXPECT_EQ(b.loop.status().state, LinkState::Connected);
  EXPECT_EQ(b.counts().connections, 2U);
  EXPECT_GT(b.counts().reports, before + 500);
  EXPECT_EQ(b.loop.status().problem, OpenProblem::None);
  EXPECT_FALSE(b.loop.status().sample.homed) << "it was without power: its posture is unknown";
  EXPECT_FALSE(b.pen.pushes()) << "or in which direction it would push";
  b.model.home();
  b.run(3);
  EXPECT_TRUE(b.pen.pushes()) << "the force ramps up again";
}

TEST(DriverLoop, APenThatKeptItsPowerKeepsItsHome) {
  Bench b;
  b.run(0.1);
  ASSERT_TRUE(b.loop.status().sample.homed);
  // The cable is moved to another port of a pen with its own supply.
  b.pen.device.deaf = true;
  b.loop.tick();
  ASSERT_EQ(b.loop.status().state, LinkState::Waiting);
  b.pen.device.deaf = false;
  b.run(1);
  ASSERT_EQ(b.loop.status().state, LinkState::Connected);
  EXPECT_TRUE(b.loop.status().sample.homed);
}

TEST(DriverLoop, StopEndsTheForceOfTheDevice) {
  Bench b;
  b.push.wrench.force = {0, 0, 1};
  b.run(3);
  ASSERT_TRUE(b.pen.pushes());
  b.loop.stop();
  EXPECT_EQ(b.last_output().enable, 0);
  EXPECT_EQ(b.loop.status().state, LinkState::Stopped);
  EXPECT_EQ(b.loop.status().wrench.force, Vec3(0));
  EXPECT_EQ(b.pen.device.open, 0);
  b.pen.run(b.clock.time + 0.02);
  EXPECT_FALSE(b.pen.pushes());
  const std::size_t written = b.pen.device.written.size();
  for (int k = 0; k < 10; ++k) b.loop.tick();
  EXPECT_EQ(b.pen.device.written.size(), written);
}

TEST(DriverLoop, ANanWrenchIsZero) {
  Bench b;
  b.push.wrench.force = {0, 0, 1};
  b.run(3);
  ASSERT_TRUE(b.pen.pushes());
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    b.push.wrench.torque.x = bad;
    b.loop.tick();
    EXPECT_EQ(b.loop.status().wrench, Wrench{});
    for (const int command : b.last_output().commands) EXPECT_EQ(command, 0);
  }
  b.run(0.02);
  EXPECT_FALSE(b.pen.pushes());
}

TEST(DriverLoop, TenThousandReportsThroughALateHost) {
  Bench b;
  stress::Random random(5);
  while (b.counts().reports < 10000) {
    // The host sleeps for up to 20 ms, now and then.
    if (random.uniform() < 0.1) b.clock.time += 0.02 * random.uniform();
    b.loop.tick();
  }
  const LinkCounts counts = b.counts();
  EXPECT_EQ(counts.lost + counts.old + counts.malformed + counts.timeouts, 0U);
  EXPECT_EQ(counts.reports, counts.superseded + static_cast<std::uint64_t>(b.push.steps));
  EXPECT_EQ(b.push.last.sequence, counts.reports);
  EXPECT_GT(counts.superseded, 1000U);
}

TEST(DriverLoop, AFloodOfReportsDoesNotDelayTheStep) {
  Script b;
  for (int k = 1; k <= 10000; ++k) b.send(input(static_cast<std::uint16_t>(k)));
  b.loop.tick();
  EXPECT_EQ(b.push.steps, 1);
  EXPECT_EQ(b.counts().reports, 256U);
}

TEST(DriverLoop, TheWrenchOfAStepThatTakesTooLongIsNotSent) {
  Script b;
  /// Pushes through the gate of all forces, and takes `takes` s for a step.
  struct Slow final : PenStep {
    explicit Slow(VirtualClock& c) : clock(c) { safety.switch_on(); }
    haptics::SafeWrench step(const PenSample&, double, double) noexcept override {
      clock.time += takes;
      for (int k = 0; k < 1000; ++k)
        safety.observe({.dt = 1e-3, .pose = {{0, 0, 0}, {0, 0, 1}}, .homed = true, .dead_man = true}),
            last = safety.release({{0, 0, 1}, {}});
      return last;
    }
    VirtualClock& clock;
    haptics::Safety safety{haptics::SafetySettings{}};
    haptics::SafeWrench last;
    double takes = 0;
  } slow(b.clock);
  DriverLoop loop(b.model, slow, b.connector, b.clock, std::make_unique<FakeTransport>(b.pen.device));
  std::uint16_t sequence = 0;
  for (const double takes : {0.0, 0.019, 0.021, 0.3, 0.0}) {
    slow.takes = takes;
    b.send(input(++sequence));
    loop.tick();
    ASSERT_NEAR(slow.last.wrench().force.z, 1, 1e-9);
    EXPECT_EQ(loop.status().wrench == Wrench{}, takes > 0.02) << takes;
    EXPECT_TRUE(takes <= 0.02 || b.last_output().enable == 0);
  }
}

TEST(DriverLoop, WrongSettingsNameTheField) {
  DriverSettings settings;
  settings.silence = -1;
  EXPECT_NE(test::error_of([&] { settings.validate(); }).find("silence"), std::string::npos);
  settings = {};
  settings.longest_retry = 0.05;
  EXPECT_NE(test::error_of([&] { settings.validate(); }).find("longest_retry"), std::string::npos);
}

}  // namespace
}  // namespace riffler::pen::driver_loop_test
