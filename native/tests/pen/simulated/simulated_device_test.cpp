// The simulated pen on the system's clock, in the driver's own thread.
#include "pen/simulated/simulated_device.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "pen/arms/redundancy.hpp"
#include "riffler/pen/registry.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::simulated_device_test {
namespace {

/// Up to 20 s, for machines that are busy.
bool comes_true(const std::function<bool()>& what) {
  for (int k = 0; k < 4000; ++k) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

TEST(SimulatedDevice, OpensByItsKindHomedAndMovesByItself) {
  const std::unique_ptr<Pen> pen = open_pen(kSimulatedKind);
  EXPECT_EQ(pen->kind(), "simulated");
  EXPECT_TRUE(pen->capability().has_force());
  ASSERT_TRUE(comes_true([&] { return pen->newest().homed; }));
  const Vec3 home = pen->newest().pose.tip;
  EXPECT_TRUE(comes_true([&] { return glm::distance(pen->newest().pose.tip, home) > 5; }));
  EXPECT_TRUE(comes_true([&] { return pen->newest().buttons == 1; }));
  EXPECT_TRUE(pen->stop());
  EXPECT_EQ(pen->status().state, LinkState::Stopped);
}

TEST(SimulatedDevice, TheHandGoesToItsTargetAndBackToItsCurve) {
  const auto pen = SimulatedDevice::open();
  ASSERT_TRUE(comes_true([&] { return pen->newest().homed; }));
  HandWish wish{.pose = pen->newest().pose, .spin = 0.3, .buttons = 2};
  wish.pose.tip += Vec3(8, -5, 4);
  pen->aim(wish);
  EXPECT_TRUE(comes_true([&] {
    const PenSample now = pen->newest();
    return glm::distance(now.pose.tip, wish.pose.tip) < 0.5 && now.buttons == 2 && std::abs(now.spin - 0.3) < 0.01;
  }));
  pen->wander();
  EXPECT_TRUE(comes_true([&] { return glm::distance(pen->newest().pose.tip, wish.pose.tip) > 5; }));
}

TEST(SimulatedDevice, PushesTheHandAway) {
  const auto pen = SimulatedDevice::open();
  ASSERT_TRUE(comes_true([&] { return pen->newest().homed; }));
  const Pose rest = pen->newest().pose;
  pen->aim({.pose = rest});
  // A machine that is late takes the force away for a while: asked for until it is there.
  EXPECT_TRUE(comes_true([&] {
    if (!haptics::heals(pen->cause())) pen->reset();
    pen->push({{0, 0, 0.7}, {}});
    return pen->newest().pose.tip.z > rest.tip.z + 0.5;
  }));
}

/// A projection on the grip's axes and back, which lie across those of the wrench: rounding is not missing.
TEST(SimulatedDevice, AWrenchThatItHasMotorsForIsMissingNothing) {
  const auto pen = SimulatedDevice::open();
  ASSERT_TRUE(comes_true([&] { return pen->newest().homed && pen->newest().powered; }));
  EXPECT_TRUE(comes_true([&] { return glm::length(pen->newest().turning) > 0.01; }));
  for (int k = 1; k < 200; ++k) {
    const Wrench wrench{{0.1 * k, 0.3, -0.7}, {}};
    const PushAnswer answer = pen->push(wrench);
    if (answer.reason == NotPushed::Tripped) continue;
    EXPECT_EQ(answer.reason, NotPushed::None);
    EXPECT_EQ(answer.felt, wrench);
    EXPECT_EQ(answer.missing, Wrench{});
  }
  const PushAnswer twist = pen->push({{}, 30.0 * pen->newest().pose.axis});
  EXPECT_GT(glm::length(twist.missing.torque), 29);
}

TEST(SimulatedDevice, LosesCountsAndTheGripShowsIt) {
  const auto pen = SimulatedDevice::open();
  ASSERT_NE(pen->geometry(), nullptr);
  const PenKinematics kinematics(*pen->geometry());
  ASSERT_TRUE(comes_true([&] { return pen->newest().homed; }));
  pen->aim({.pose = pen->newest().pose});
  EXPECT_TRUE(comes_true([&] { return std::abs(pen->newest().stretch) < pen->geometry()->grip_tolerance; }));
  pen->lose(1, 60);  // R3, which moves its end along the grip at home
  EXPECT_TRUE(comes_true([&] { return std::abs(pen->newest().stretch) > 3 * pen->geometry()->grip_tolerance; }));
  const PenSample sample = pen->newest();
  EXPECT_EQ(check_grip(kinematics, kinematics.posture(sample.counts)).stretch, sample.stretch);
  pen->lose(1, 0);
  EXPECT_TRUE(comes_true([&] { return std::abs(pen->newest().stretch) < pen->geometry()->grip_tolerance; }));
  EXPECT_EQ(test::error_of([&] { pen->lose(6, 1); }), "channel must be 0 to 5, not 6");
}

TEST(SimulatedDevice, UnpluggedItDisappearsAndPluggedInItReturns) {
  const auto pen = SimulatedDevice::open();
  ASSERT_TRUE(comes_true([&] { return pen->newest().homed; }));
  for (int round = 0; round < 2; ++round) {
    pen->unplug();
    EXPECT_TRUE(comes_true([&] { return pen->status().state != LinkState::Connected; }));
    const auto seen = pen->newest().sequence;
    EXPECT_TRUE(comes_true([&] { return pen->status().problem == OpenProblem::NoFile; }));
    EXPECT_EQ(pen->newest().sequence, seen);
    pen->plug();
    EXPECT_TRUE(
        comes_true([&] { return pen->status().state == LinkState::Connected && pen->newest().sequence > seen; }));
  }
}

TEST(SimulatedDevice, ImpossibleCommandsAreRefused) {
  const auto pen = SimulatedDevice::open();
  const auto refused = [&](const HandWish& wish) { return test::error_of([&] { pen->aim(wish); }); };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(refused({.pose = {{0, nan, 0}, {0, 0, 1}}}), "pose: the point must be finite");
  EXPECT_EQ(refused({.pose = {{0, 0, 0}, {0, 0, 0}}}), "pose: the axis must be finite, not zero");
  EXPECT_EQ(refused({.spin = nan}), "spin must be finite");
  EXPECT_EQ(refused({.grip = 2}), "grip must be a number between 0.000000 and 1.000000");
}

}  // namespace
}  // namespace riffler::pen::simulated_device_test
