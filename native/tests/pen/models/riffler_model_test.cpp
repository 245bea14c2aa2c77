// Riffler's pen as the host sees it: who it is, where it stands, when it may push. Judged by the reference firmware and
// by the kinematics.
#include "pen/models/riffler_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "pen/arms/pens.hpp"
#include "pen/fake_link.hpp"
#include "riffler/pen/arms/motors.hpp"
#include "stress/random.hpp"
#include "support/pens.hpp"

namespace riffler::pen::riffler_model_test {
namespace {

using test::ConstantPush;
using test::FakeConnector;
using test::FakeTransport;
using test::FirmwarePen;
using test::VirtualClock;

struct Bench {
  VirtualClock clock;
  FirmwarePen pen{clock};

  OpenProblem problem(std::string& text) {
    try {
      FakeTransport transport(pen.device);
      const RifflerModel model(transport);
    } catch (const OpenError& error) {
      text = error.what();
      return error.problem();
    }
    return OpenProblem::None;
  }
};

TEST(RifflerModel, NamesTheReasonIfAPenDoesNotOpen) {
  std::string text;
  {
    Bench b;
    EXPECT_EQ(b.problem(text), OpenProblem::None) << text;
    b.pen.config.identity.major = 9;
    b.pen.device.hid.clear();  // of another version the descriptor may differ; the version is what helps
    EXPECT_EQ(b.problem(text), OpenProblem::OtherVersion);
    EXPECT_NE(text.find("9.0"), std::string::npos) << text;
  }
  {
    Bench b;
    b.pen.device.hid.pop_back();
    EXPECT_EQ(b.problem(text), OpenProblem::WrongDescriptor);
    EXPECT_NE(text.find("at byte " + std::to_string(riffler_pen_descriptor_size - 1)), std::string::npos) << text;
    b.pen.device.hid.assign(3, 0);
    EXPECT_EQ(b.problem(text), OpenProblem::WrongDescriptor);
  }
  {
    Bench b;
    std::strcpy(b.pen.config.identity.geometry, "nobody-knows");
    EXPECT_EQ(b.problem(text), OpenProblem::BadContent);
    EXPECT_NE(text.find("nobody-knows"), std::string::npos) << text;
    std::strcpy(b.pen.config.identity.geometry, "/etc/passwd");
    EXPECT_EQ(b.problem(text), OpenProblem::BadContent) << "a device does not choose files";
    EXPECT_NE(text.find("must not contain a folder"), std::string::npos) << text;
  }
  {
    Bench b;
    b.pen.config.limits.peak_ma[2] = 0;
    EXPECT_EQ(b.problem(text), OpenProblem::BadContent);
    b.pen.device.feature = [](std::span<std::uint8_t>) { return -1; };
    EXPECT_EQ(b.problem(text), OpenProblem::NoAnswer);
    b.pen.device.feature = [](std::span<std::uint8_t> bytes) {
      std::fill(bytes.begin() + 1, bytes.end(), std::uint8_t{7});
      return static_cast<int>(bytes.size());
    };
    EXPECT_EQ(b.problem(text), OpenProblem::UnknownDevice);
  }
}

TEST(RifflerModel, AnotherPenInTheSamePlaceIsRefused) {
  Bench b;
  FakeTransport transport(b.pen.device);
  RifflerModel model(transport);
  model.check(transport);
  b.pen.config.identity.serial[0] ^= 1;
  EXPECT_THROW(model.check(transport), OpenError);
}

TEST(RifflerModel, ItsStrengthIsTheWeakerOfFirmwareAndGeometry) {
  Bench b;
  FakeTransport transport(b.pen.device);
  const double before = RifflerModel(transport).capability()[Coordinate::X].peak;
  for (auto& peak : b.pen.config.limits.peak_ma) peak = 500;
  for (auto& continuous : b.pen.config.limits.continuous_ma) continuous = 200;
  b.pen.config.limits.stall_ma = 150;
  const double after = RifflerModel(transport).capability()[Coordinate::X].peak;
  EXPECT_GT(before, 0);
  EXPECT_LT(after, before);
}

/// On the driver's loop, homed.
struct Driven : Bench {
  Driven() { model.home(); }
  FakeConnector connector{pen.device};
  ConstantPush push;
  std::unique_ptr<HidTransport> transport = std::make_unique<FakeTransport>(pen.device);
  RifflerModel model{*transport};
  DriverLoop loop{model, push, connector, clock, std::move(transport)};

  void run(double seconds) {
    const double end = clock.time + seconds;
    while (clock.time < end) loop.tick();
  }
};

TEST(RifflerModel, GivesThePostureOfItsCounters) {
  Driven d;
  d.run(0.05);
  d.run(0.01);
  const PenKinematics kinematics(load_pen("riffler"));
  const Pose home = kinematics.posture(kinematics.home_angles()).pose;
  const PenSample sample = d.loop.status().sample;
  EXPECT_TRUE(sample.homed);
  EXPECT_LT(glm::length(sample.pose.tip - home.tip), 1e-9);
  EXPECT_LT(glm::length(sample.pose.axis - home.axis), 1e-12);
  EXPECT_LT(std::abs(sample.stretch), 0.25);
}

TEST(RifflerModel, MeasuresItsSpeed) {
  Driven d;
  d.run(0.05);
  // Joint θ1 of both arms turns at 1000 counts a second.
  d.pen.on_step = [&] { ++d.pen.sensors.counters[2], ++d.pen.sensors.counters[5]; };
  d.run(0.05);
  const PenSample a = d.loop.status().sample;
  d.run(0.01);
  const PenSample b = d.loop.status().sample;
  const Vec3 expected = (b.pose.tip - a.pose.tip) / (b.time - a.time);
  EXPECT_GT(glm::length(expected), 1);
  EXPECT_LT(glm::length(b.velocity - expected), 0.05 * glm::length(expected));
}

/// Nothing to push with is no reason to switch off: the next touch would begin with the firmware's ramp.
TEST(RifflerModel, TheMotorsAreOnAsLongAsTheGateIsOpen) {
  Driven d;
  d.push.holds = false;
  d.push.wrench.force = {0, 0, 1};
  d.run(1);
  EXPECT_EQ(d.pen.firmware.state, RIFFLER_PEN_IDLE);
  d.push.holds = true;
  d.push.wrench = {};
  d.run(3);
  EXPECT_EQ(d.pen.firmware.state, RIFFLER_PEN_ACTIVE);
  EXPECT_FALSE(d.pen.pushes());
  d.push.wrench.force = {0, 0, 1};
  d.run(0.02);
  const std::array<std::int16_t, RIFFLER_PEN_JOINTS> soon = std::to_array(d.pen.drive.current_ma);
  EXPECT_TRUE(d.pen.pushes());
  d.run(1);
  for (std::size_t k = 0; k < soon.size(); ++k) EXPECT_NEAR(soon[k], d.pen.drive.current_ma[k], 2) << "without a ramp";
  d.push.holds = false;
  d.run(0.005);
  EXPECT_EQ(d.pen.firmware.state, RIFFLER_PEN_ACTIVE) << "while the force falls";
  d.run(haptics::SafetySettings{}.fall);
  EXPECT_EQ(d.pen.firmware.state, RIFFLER_PEN_IDLE);
  EXPECT_EQ(d.pen.firmware.fault_count, 0);
}

TEST(RifflerModel, DoesNotPushBeforeItIsHomed) {
  Bench b;
  FakeConnector connector(b.pen.device);
  ConstantPush push;
  auto transport = std::make_unique<FakeTransport>(b.pen.device);
  RifflerModel model(*transport);
  DriverLoop loop(model, push, connector, b.clock, std::move(transport));
  push.wrench.force = {0, 0, 1};
  const auto run = [&](double seconds) {
    for (const double end = b.clock.time + seconds; b.clock.time < end;) loop.tick();
  };
  run(3);
  EXPECT_EQ(b.pen.firmware.state, RIFFLER_PEN_IDLE);
  EXPECT_FALSE(loop.status().sample.homed);
  EXPECT_TRUE(model.home());
  run(3);
  EXPECT_TRUE(b.pen.pushes());
}

TEST(RifflerModel, AnyBytesAreReportsOrCounted) {
  Driven d;
  d.run(0.01);
  stress::Random random(4);
  std::array<std::uint8_t, 65> out{};
  for (int k = 0; k < 20000; ++k) {
    test::Report bytes(static_cast<std::size_t>(random.uniform() * 200));
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random.uniform() * 256);
    // Half of them begin as reports do.
    if (!bytes.empty() && k % 2 == 0) bytes[0] = RIFFLER_PEN_INPUT_ID;
    const Taken taken = d.model.take(bytes, d.clock.time);
    EXPECT_EQ(taken.reports + taken.old + taken.malformed,
              (bytes.size() + RIFFLER_PEN_INPUT_SIZE - 1) / RIFFLER_PEN_INPUT_SIZE);
    const PenSample sample = d.model.sample(d.clock.time);
    EXPECT_TRUE(geom::finite(sample.pose.tip) && geom::finite(sample.pose.axis) && geom::finite(sample.velocity));
    EXPECT_EQ(d.model.push(test::let_through({{1, 2, 3}, {4, 5, 6}}), d.clock.time, out),
              static_cast<std::size_t>(RIFFLER_PEN_OUTPUT_SIZE));
  }
}

TEST(RifflerModel, TheMotorsBalanceTheForceByVirtualWork) {
  Driven d;
  d.run(0.05);
  d.push.wrench.force = {0.3, -0.2, 0.4};
  d.run(3);
  // Σ τ_motor · δ(motor) = f · δ(tip) for a small turn of any joint, with the grip's two ends independent: compare the
  // arms' joint torques with those of half the force on each end.
  const PenKinematics kinematics(load_pen("riffler"));
  const PenGeometry& pen = kinematics.geometry();
  MotorTorques torques{};
  for (std::size_t k = 0; k < kPenChannels; ++k)
    torques[k] = 1e-3 * d.pen.drive.current_ma[k] * pen.channels[k].torque_constant;
  const JointAngles joints = joint_torques(pen, torques);
  const JointAngles home = kinematics.home_angles();
  for (const Arm arm : {Arm::R, Arm::L})
    for (int j = 0; j < 3; ++j) {
      constexpr double kStep = 1e-6;
      JointAngles there = home;
      there[index(arm)][j] += kStep;
      const Vec3 moved = kinematics.posture(there).pose.tip - kinematics.posture(home).pose.tip;
      // The pivot is midway: turning one arm's joint moves it by half of that arm's end.
      EXPECT_NEAR(joints[index(arm)][j], glm::dot(d.push.wrench.force, moved) / kStep, 0.02 * 30) << j;
    }
}

TEST(RifflerModel, AFaultOfThePenIsReported) {
  Driven d;
  d.push.wrench.force = {0, 0, 1};
  d.run(3);
  ASSERT_TRUE(d.pen.pushes());
  d.pen.sensors.stopped = 1;
  d.run(0.01);
  EXPECT_EQ(d.loop.status().sample.fault, static_cast<unsigned>(RIFFLER_PEN_EMERGENCY_STOP));
  EXPECT_FALSE(d.loop.status().sample.powered);
  EXPECT_FALSE(d.pen.pushes());
  d.pen.sensors.stopped = 0;
  d.run(3);
  EXPECT_EQ(d.loop.status().sample.fault, 0U);
  EXPECT_TRUE(d.pen.pushes()) << "by way of the ramp";
}

TEST(RifflerModel, CommandsAreAcceptedAfterAnotherHostsNumbers) {
  for (const int number : {1, 20000, 40000, 65535}) {
    Driven d;
    // Another host was heard a moment ago.
    riffler_pen_output other{};
    other.sequence = static_cast<std::uint16_t>(number);
    test::Report bytes(RIFFLER_PEN_OUTPUT_SIZE);
    riffler_pen_encode_output(&other, bytes.data());
    d.pen.power_on();
    d.pen.device.on_write(bytes);
    d.push.wrench.force = {0, 0, 1};
    d.run(3);
    EXPECT_TRUE(d.pen.pushes()) << number;
    EXPECT_LT(d.pen.firmware.link.refused_count, 10) << number;
  }
}

}  // namespace
}  // namespace riffler::pen::riffler_model_test
