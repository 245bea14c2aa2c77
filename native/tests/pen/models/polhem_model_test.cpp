#include "pen/models/polhem_model.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pen/fake_link.hpp"
#include "stress/random.hpp"
#include "support/hid_devices.hpp"

namespace riffler::pen::polhem_model_test {
namespace {

using test::Bytes;

using test::polhem_report;

int field(std::span<const std::uint8_t> bytes, std::size_t k) {
  return static_cast<std::int16_t>(bytes[1 + 2 * k] | (bytes[2 + 2 * k] << 8));
}

struct Arm3 {
  explicit Arm3(const char* name = "woodenhaptics") {
    device.clock = &clock;
    device.hid = test::teensy_descriptor();
    test::FakeTransport transport(device);
    model = std::make_unique<PolhemModel>(transport, *polhem_geometry(name));
    model->begin(0);
  }
  /// Homed, at counters a b c.
  void home_at(int a, int b, int c) {
    model->home();
    model->push({}, 0, out);
    const auto& preset = polhem_geometry("woodenhaptics")->preset;
    model->take(polhem_report({preset[0], preset[1], preset[2], 0, 0, 0, 0}), 0);
    model->take(polhem_report({a, b, c, 0, 0, 0, 0}), 1e-3);
  }
  test::VirtualClock clock;
  test::FakeDevice device;
  std::unique_ptr<PolhemModel> model;
  std::array<std::uint8_t, 65> out{};
};

TEST(Polhem, ItsJacobianIsThatOfFiniteDifferences) {
  stress::Random random(3);
  for (const char* name : {"woodenhaptics", "polhem-1"})
    for (int k = 0; k < 200; ++k) {
      const PolhemGeometry& g = *polhem_geometry(name);
      const Vec3 angles(random.uniform() - 0.5, random.uniform() * 2 - 1, random.uniform() * 2);
      const PolhemPosture posture = polhem_posture(g, angles);
      for (int j = 0; j < 3; ++j) {
        constexpr double kStep = 1e-5;
        Vec3 up = angles, down = angles;
        up[j] += kStep, down[j] -= kStep;
        const Vec3 slope = (polhem_posture(g, up).tip - polhem_posture(g, down).tip) / (2 * kStep);
        EXPECT_LT(glm::length(slope - posture.jacobian[j]), 1e-6);
      }
    }
}

TEST(Polhem, HasThePoseOfItsArms) {
  const PolhemGeometry& g = *polhem_geometry("woodenhaptics");
  // Upper arm upright, fore arm level: a reach of the fore arm at the height of the shoulder and the upper arm.
  const PolhemPosture posture = polhem_posture(g, {0, 0, kPi / 2});
  EXPECT_LT(glm::length(posture.tip + g.origin - Vec3(245, 0, 285)), 1e-9);
}

TEST(Polhem, DoesNotPushBeforeItIsHomed) {
  Arm3 arm;
  arm.model->take(polhem_report({0, 0, 6000, 0, 0, 0, 0}), 0);
  EXPECT_FALSE(arm.model->sample(0).homed);
  EXPECT_EQ(arm.model->push(test::let_through({{0, 0, 1}, {}}), 0, arm.out), 65U);
  for (std::size_t k = 0; k < 7; ++k) EXPECT_EQ(field(arm.out, k), 0);
}

TEST(Polhem, HomingPresetsTheCountersAndWaitsUntilTheyShowIt) {
  Arm3 arm;
  arm.model->take(polhem_report({17, -900, 40, 0, 0, 0, 0}), 0);
  EXPECT_TRUE(arm.model->home());
  arm.model->push(test::let_through({{0, 0, 1}, {}}), 0, arm.out);
  EXPECT_EQ(field(arm.out, 3), 1);
  EXPECT_EQ(field(arm.out, 6), 6000);
  EXPECT_EQ(field(arm.out, 0), 0) << "these would be presets of the wrist, not currents";
  arm.model->take(polhem_report({17, -900, 40, 0, 0, 0, 0}), 1e-3);
  EXPECT_FALSE(arm.model->sample(0).homed);
  arm.model->take(polhem_report({0, 1, 6000, 0, 0, 0, 0}), 2e-3);
  const PenSample sample = arm.model->sample(0);
  EXPECT_TRUE(sample.homed);
  EXPECT_EQ(sample.velocity, Vec3(0)) << "a preset is not motion";
  arm.model->push({}, 0, arm.out);
  EXPECT_EQ(field(arm.out, 3), 0);
}

TEST(Polhem, MotorsBalanceTheForceByVirtualWork) {
  Arm3 arm;
  arm.home_at(300, -1500, 5000);
  const PolhemGeometry& g = *polhem_geometry("woodenhaptics");
  const Vec3 force(0.4, -0.3, 0.5);
  arm.model->push(test::let_through({force, {}}), 0, arm.out);
  const Vec3 at = arm.model->sample(0).pose.tip;
  std::vector<int> counts{300, -1500, 5000, 0, 0, 0, 0};
  for (std::size_t j = 0; j < 3; ++j) {
    // A count of one motor: its torque times its turn is the force times the displacement.
    auto there = counts;
    there[j] += 1;
    arm.model->take(polhem_report(there), 2e-3);
    const double work = glm::dot(force, arm.model->sample(0).pose.tip - at);
    const double torque = 1e-3 * field(arm.out, j) * g.torque_constant[j];
    EXPECT_NEAR(torque * 2 * kPi / g.counts, work, 0.01 * std::abs(work) + 1e-4) << j;
    arm.model->take(polhem_report(counts), 3e-3);
  }
}

TEST(Polhem, ATooLargeForceKeepsItsDirection) {
  Arm3 arm;
  arm.home_at(300, -1500, 5000);
  const Vec3 force(0.4, -0.3, 0.5);
  arm.model->push(test::let_through({force, {}}), 0, arm.out);
  const std::array<double, 3> small{1.0 * field(arm.out, 0), 1.0 * field(arm.out, 1), 1.0 * field(arm.out, 2)};
  arm.model->push(test::let_through({1000.0 * force, {}}), 0, arm.out);
  int most = 0;
  for (std::size_t j = 0; j < 3; ++j) most = std::max(most, std::abs(field(arm.out, j)));
  EXPECT_EQ(most, 2000);
  for (std::size_t j = 1; j < 3; ++j)
    EXPECT_NEAR(field(arm.out, j) / small[j], field(arm.out, 0) / small[0], 0.02 * field(arm.out, 0) / small[0]);
}

TEST(Polhem, CountersOfSixteenBitsUnwrap) {
  Arm3 arm;
  arm.home_at(0, 0, 6000);
  int a = 0;
  for (int k = 0; k < 10; ++k) {
    a += 5000;
    arm.model->take(polhem_report({static_cast<std::int16_t>(a), 0, 6000, 0, 0, 0, 0}), 1e-3 * (k + 2));
  }
  const double angle = 2 * kPi * 50000 / (2000.0 * 16);
  const PenSample sample = arm.model->sample(0);
  const Vec3 tip = sample.pose.tip + polhem_geometry("woodenhaptics")->origin;
  EXPECT_NEAR(std::atan2(tip.y, tip.x), std::remainder(angle, 2 * kPi), 1e-9);
}

TEST(Polhem, TheButtonHidesInACounter) {
  Arm3 arm;
  arm.model->take(polhem_report({0, 0, 0, 9980, 0, 0, 0}), 0);
  EXPECT_EQ(arm.model->sample(0).buttons, 1U);
  arm.model->take(polhem_report({0, 0, 0, -20, 0, 0, 0}), 0);
  EXPECT_EQ(arm.model->sample(0).buttons, 0U);
}

TEST(Polhem, MergedAndShortReportsAreHandled) {
  Arm3 arm;
  Bytes two = polhem_report({1, 0, 0, 0, 0, 0, 0}), more = polhem_report({2, 0, 0, 0, 0, 0, 0});
  two.insert(two.end(), more.begin(), more.end());
  EXPECT_EQ(arm.model->take(two, 0).reports, 2U);
  two.resize(100);
  const Taken taken = arm.model->take(two, 0);
  EXPECT_EQ(taken.reports, 1U);
  EXPECT_EQ(taken.malformed, 1U);
}

TEST(Polhem, AnotherDescriptorIsRefused) {
  test::FakeDevice device;
  test::VirtualClock clock;
  device.clock = &clock;
  device.hid = test::puck_descriptor(true);
  test::FakeTransport transport(device);
  EXPECT_THROW(PolhemModel(transport, *polhem_geometry("polhem-1")), OpenError);
  EXPECT_EQ(polhem_geometry("polhem-3"), nullptr);
}

}  // namespace
}  // namespace riffler::pen::polhem_model_test
