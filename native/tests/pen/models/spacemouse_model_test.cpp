#include "pen/models/spacemouse_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pen/fake_link.hpp"
#include "riffler/pen/registry.hpp"
#include "stress/random.hpp"
#include "support/hid_devices.hpp"

namespace riffler::pen::spacemouse_model_test {
namespace {

using test::Bytes;
using test::puck_info;
using test::puck_report;

struct Puck {
  explicit Puck(bool joined, const RateSettings& settings = {}) {
    device.clock = &clock;
    device.hid = test::puck_descriptor(joined);
    test::FakeTransport transport(device);
    model = std::make_unique<SpaceMouseModel>(transport, puck_info(), settings);
    model->begin(clock.time);
  }
  Taken take(const Bytes& bytes) { return model->take(bytes, clock.time); }
  PenSample after(double seconds) {
    clock.time += seconds;
    return model->sample(clock.time);
  }
  test::VirtualClock clock;
  test::FakeDevice device;
  std::unique_ptr<SpaceMouseModel> model;
};

RateSettings straight() {
  RateSettings settings;
  settings.bubble = 0, settings.exponent = 1, settings.speed = 100, settings.turn_rate = 1;
  return settings;
}

TEST(SpaceMouse, SplitAndJoinedReportsGiveTheSame) {
  for (const bool joined : {false, true}) {
    Puck puck(joined, straight());
    if (joined) {
      EXPECT_EQ(puck.take(puck_report(1, {175, 0, 0, 0, 0, 350})).reports, 1U);
    } else {
      EXPECT_EQ(puck.take(puck_report(1, {175, 0, 0})).reports, 1U);
      EXPECT_EQ(puck.take(puck_report(2, {0, 0, 350})).reports, 1U);
    }
    const PenSample sample = puck.after(0.1);
    EXPECT_NEAR(sample.velocity.x, 50, 1e-9);
    EXPECT_NEAR(sample.pose.tip.x, 5, 1e-9);
    EXPECT_NEAR(sample.turning.z, -1, 1e-9) << "the puck's z is down";
    EXPECT_NEAR(sample.spin, -0.1, 1e-9);
  }
}

TEST(SpaceMouse, AxesAreRightAwayAndUp) {
  Puck puck(true, straight());
  puck.take(puck_report(1, {350, 350, 350, 0, 0, 0}));
  EXPECT_LT(glm::length(puck.after(0).velocity - 100 / std::sqrt(3) * Vec3(1, -1, -1)), 1e-9);
}

TEST(SpaceMouse, MergedReportsAreSplit) {
  Puck puck(false, straight());
  Bytes both = puck_report(1, {350, 0, 0});
  const Bytes rotation = puck_report(2, {350, 0, 0});
  both.insert(both.end(), rotation.begin(), rotation.end());
  both.insert(both.end(), {3, 2, 0});
  const Taken taken = puck.take(both);
  EXPECT_EQ(taken.reports, 3U);
  EXPECT_EQ(taken.malformed, 0U);
  EXPECT_EQ(puck.after(0).buttons, 2U);
  // A joined report whose first rotation begins with the byte 2 is not two split ones.
  Puck other(true, straight());
  EXPECT_EQ(other.take(puck_report(1, {1, 2, 3, 2, 5, 6})).reports, 1U);
}

TEST(SpaceMouse, ShortAndUnknownReportsChangeNothing) {
  Puck puck(false, straight());
  puck.take(puck_report(1, {350, 0, 0}));
  EXPECT_EQ(puck.take({1, 0, 0}).malformed, 1U);
  EXPECT_EQ(puck.take({23, 80}).malformed, 1U);
  EXPECT_EQ(puck.after(0).velocity.x, 100);
  EXPECT_EQ(puck.after(0).sequence, 1U);
}

TEST(SpaceMouse, AnyBytesLeaveFiniteSpeeds) {
  Puck puck(true);
  stress::Random random(8);
  for (int k = 0; k < 20000; ++k) {
    Bytes bytes(static_cast<std::size_t>(random.uniform() * 60));
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random.uniform() * 256);
    if (!bytes.empty()) bytes[0] = static_cast<std::uint8_t>(random.uniform() * 4);
    puck.take(bytes);
    const PenSample sample = puck.after(1e-3);
    EXPECT_LE(glm::length(sample.velocity), 60.001);
    EXPECT_NEAR(glm::length(sample.pose.axis), 1, 1e-9);
  }
}

TEST(SpaceMouse, AnUnpluggedPuckStandsStill) {
  Puck puck(true, straight());
  puck.take(puck_report(1, {350, 0, 0, 0, 0, 0}));
  const Vec3 there = puck.after(0.1).pose.tip;
  puck.model->begin(puck.clock.time += 5);
  EXPECT_EQ(puck.after(1).pose.tip, there);
}

TEST(SpaceMouse, OverflowOfTheDeflectionIsFullDeflection) {
  Puck puck(true, straight());
  puck.take(puck_report(1, {32767, -32768, 400, 0, 0, 0}));
  EXPECT_NEAR(glm::length(puck.after(0).velocity), 100, 1e-9);
}

TEST(SpaceMouse, EachFamilyIsRecognisedAndSensesSixRates) {
  for (const auto& [vendor, product] :
       {std::pair{0x046D, 0xC626}, {0x046D, 0xC62B}, {0x256F, 0xC62E}, {0x256F, 0xC635}, {0x256F, 0xC652}}) {
    const HidInfo info = puck_info(static_cast<std::uint16_t>(vendor), static_cast<std::uint16_t>(product));
    ASSERT_NE(family_of(info), nullptr) << info.id();
    EXPECT_STREQ(family_of(info)->kind, "spacemouse");
  }
  HidInfo keyboard = puck_info();
  keyboard.usages = {{1, 6}};
  EXPECT_EQ(family_of(keyboard), nullptr) << "another interface of a receiver";
  Puck puck(true);
  EXPECT_EQ(puck.model->capability()[Coordinate::C].sensing, Sensing::Rate);
  EXPECT_FALSE(puck.model->capability().has_force());
  std::array<std::uint8_t, 65> bytes{};
  EXPECT_EQ(puck.model->push(test::let_through({{1, 0, 0}, {}}), 0, bytes), 0U);
}

TEST(SpaceMouse, AnotherDescriptorIsRefused) {
  for (const Bytes& hid : {Bytes{}, test::teensy_descriptor(), Bytes{0x05, 0x01, 0x09}}) {
    test::FakeDevice device;
    test::VirtualClock clock;
    device.clock = &clock;
    device.hid = hid;
    test::FakeTransport transport(device);
    EXPECT_THROW(SpaceMouseModel(transport, puck_info()), OpenError);
  }
}

TEST(RateControl, TheBubbleIsABallAndTheCurveKeepsTheDirection) {
  EXPECT_EQ(shaped({0.05, 0.05, 0}, 0.08, 2), Vec3(0));
  EXPECT_EQ(shaped({NAN, 0, 0}, 0.08, 2), Vec3(0));
  EXPECT_NEAR(glm::length(shaped({0.08 + 1e-9, 0, 0}, 0.08, 2)), 0, 1e-15) << "continuous at the edge";
  EXPECT_NEAR(glm::length(shaped({1, 0, 0}, 0.08, 2)), 1, 1e-12);
  EXPECT_NEAR(glm::length(shaped({1, 1, 1}, 0.08, 2)), 1, 1e-12) << "not faster along diagonals";
  const Vec3 push(0.3, -0.2, 0.05);
  EXPECT_LT(glm::length(glm::cross(glm::normalize(shaped(push, 0.08, 2)), glm::normalize(push))), 1e-12);
}

TEST(RateControl, HoldsTheOrientationAndTurnsSigns) {
  RateSettings settings = straight();
  settings.hold_orientation = true;
  settings.signs = {-1, 0, 1, 1, 1, 1};
  RateControl control(settings);
  control.push({1, 0, 0}, {1, 0, 0});
  control.advance(0);
  control.advance(0.1);
  EXPECT_NEAR(control.pose().tip.x, -10, 1e-9);
  EXPECT_EQ(control.pose().axis, Vec3(0, 0, 1));
  control.push({0, 1, 0}, {0, 0, 0});
  EXPECT_EQ(control.velocity(), Vec3(0));
  control.advance(100);
  EXPECT_EQ(control.pose().tip.y, 0);
}

TEST(RateControl, TheAxisTurnsOnAGreatCircle) {
  RateControl control(straight());
  control.push({}, {1, 0, 0});
  control.advance(0);
  for (int k = 1; k <= 1000; ++k) control.advance(1e-3 * k);
  EXPECT_NEAR(glm::length(control.pose().axis - Vec3(0, -std::sin(1), std::cos(1))), 0, 1e-9);
  EXPECT_NEAR(glm::length(control.pose().axis), 1, 1e-14);
}

TEST(RateControl, ASuspendedMachineDoesNotJump) {
  RateControl control(straight());
  control.push({1, 0, 0}, {});
  control.advance(0);
  control.advance(3600);
  EXPECT_NEAR(control.pose().tip.x, 10, 1e-9);
  control.advance(10);  // and a clock that falls does nothing
  EXPECT_NEAR(control.pose().tip.x, 10, 1e-9);
}

TEST(RateControl, WrongSettingsAreRefused) {
  RateSettings settings;
  settings.bubble = 1;
  EXPECT_THROW(RateControl{settings}, std::invalid_argument);
  settings = {};
  settings.signs[3] = 2;
  EXPECT_THROW(RateControl{settings}, std::invalid_argument);
  settings = {};
  settings.speed = NAN;
  EXPECT_THROW(RateControl{settings}, std::invalid_argument);
}

}  // namespace
}  // namespace riffler::pen::spacemouse_model_test
