// Bounds that hold wherever the arms stand, judged by the kinematics of random postures.
#include "riffler/pen/passivity_settings.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "riffler/pen/arms/arm.hpp"
#include "riffler/pen/arms/motors.hpp"
#include "stress/random.hpp"
#include "support/pens.hpp"

namespace riffler::pen::passivity_settings_test {
namespace {

/// Angles that limits of joints and elbows allow, each end on its own: the bounds ask for no grip.
JointAngles random_angles(const PenGeometry& pen, stress::Random& random) {
  for (;;) {
    JointAngles out{};
    for (const PenChannel& c : pen.channels) out[index(c.arm)][c.joint] = random.uniform(c.low, c.high);
    const auto bent = [&](const Vec3& q) { return q.y - q.z > pen.elbow_low && q.y - q.z < pen.elbow_high; };
    if (bent(out[0]) && bent(out[1])) return out;
  }
}

/// A grip between the ends of random postures moves as its ends do: what the joints lose, against the credit.
struct Margin {
  double damping = 1e300, friction = 1e300, linear = 0, angular = 0;
};

Margin least_margin(const PenGeometry& pen, const haptics::PassivitySettings& s, int rounds) {
  const PenKinematics kinematics(pen);
  stress::Random random(5);
  Margin out;
  for (int round = 0; round < rounds; ++round) {
    const PenPosture posture = kinematics.posture(random_angles(pen, random));
    // A rigid grip of the pen's own length in any direction, and any motion of it without a turn about itself.
    const auto direction = [&] {
      return glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) + Vec3(1e-9));
    };
    const Vec3 r = 0.5 * pen.grip_length * direction();
    const Vec3 v = random.uniform(0, 1) * direction();
    const Vec3 turn = random.uniform(0, 1) / (0.5 * pen.grip_length) * glm::cross(direction(), glm::normalize(r));
    JointAngles rates{};
    for (std::size_t arm = 0; arm < 2; ++arm)
      rates[arm] = glm::inverse(posture.arms[arm].jacobian) * (v + (arm == 0 ? -1.0 : 1.0) * glm::cross(turn, r));
    double damped = 0, rubbed = 0;
    for (const PenChannel& c : pen.channels) {
      const double rate = rates[index(c.arm)][c.joint] * c.ratio;
      damped += c.viscous * rate * rate, rubbed += c.coulomb * std::abs(rate);
    }
    double damp_credit = 0, rub_credit = 0;
    for (int k = 0; k < 3; ++k) {
      damp_credit += s.device_damping.linear * v[k] * v[k] + s.device_damping.angular * turn[k] * turn[k];
      rub_credit += s.device_friction.linear * std::abs(v[k]) + s.device_friction.angular * std::abs(turn[k]);
    }
    out.damping = std::min(out.damping, damped / damp_credit);
    out.friction = std::min(out.friction, rubbed / rub_credit);
    // Half a count of every joint, in either direction.
    Vec3 ends[2] = {Vec3(0), Vec3(0)};
    const Vec3 along = direction();
    for (const PenChannel& c : pen.channels) {
      const Vec3 step = kPi / c.steps * posture.arms[index(c.arm)].jacobian[c.joint];
      ends[index(c.arm)] += glm::dot(step, along) < 0 ? -step : step;
    }
    out.linear = std::max(out.linear, glm::dot(0.5 * (ends[0] + ends[1]), along));
    out.angular = std::max(out.angular, glm::dot(ends[0] + ends[1], along) / pen.grip_length);
  }
  return out;
}

TEST(PassivitySettings, OfThePenHoldInEveryPostureAndAreNotFarFromTheWorst) {
  const PenGeometry pen = load_pen("riffler");
  const haptics::PassivitySettings s = passivity_settings(pen);
  s.validate();
  const Margin margin = least_margin(pen, s, 200'000);
  EXPECT_GE(margin.damping, 1);
  EXPECT_LT(margin.damping, 2);
  EXPECT_GE(margin.friction, 1);
  EXPECT_LT(margin.friction, 3);
  EXPECT_LE(margin.linear, 0.5 * s.resolution.linear);
  EXPECT_GT(margin.linear, 0.35 * s.resolution.linear);
  EXPECT_LE(margin.angular, 0.5 * s.resolution.angular);
}

TEST(PassivitySettings, OnlyUncompensatedLossesAreCredited) {
  const PenGeometry pen = load_pen("riffler");
  const haptics::PassivitySettings all = passivity_settings(pen), some = passivity_settings(pen, {1, 0.7});
  EXPECT_NEAR(some.device_damping.linear, 0.3 * all.device_damping.linear, 1e-15);
  EXPECT_NEAR(some.device_friction.angular, 0.3 * all.device_friction.angular, 1e-12);
  EXPECT_EQ(some.resolution.linear, all.resolution.linear);
}

TEST(PassivitySettings, MissingValuesAreZero) {
  PenGeometry pen = load_pen("riffler");
  pen.channels[2].viscous = pen.channels[4].coulomb = 0;
  EXPECT_EQ(passivity_settings(pen).device_damping.linear, 0) << "a motion that only this joint makes costs nothing";
  EXPECT_EQ(passivity_settings(pen).device_friction.linear, 0);
  DeviceCapability device;
  device[Coordinate::Y].resolution = 0.1;
  const haptics::PassivitySettings s = passivity_settings(device);
  s.validate();
  EXPECT_EQ(s.resolution.linear, 0.1);
  EXPECT_EQ(s.resolution.angular, 0);
  EXPECT_EQ(s.device_damping.linear + s.device_friction.linear, 0);
}

/// A pen that was identified gets its credit by what its joints really did: nothing is credited twice.
TEST(PassivitySettings, OfAnIdentifiedPenHaveNoLossesOfTheirOwn) {
  PenGeometry pen = load_pen("riffler");
  const haptics::PassivitySettings before = passivity_settings(pen);
  pen.uncertainty.emplace();
  const haptics::PassivitySettings s = passivity_settings(pen);
  EXPECT_EQ(s.device_damping.linear + s.device_damping.angular, 0);
  EXPECT_EQ(s.device_friction.linear + s.device_friction.angular, 0);
  EXPECT_EQ(s.resolution.linear, before.resolution.linear);
  EXPECT_EQ(s.latency, before.latency);
}

/// Currents that change at 100 A/s change any wrench at least this fast, in every posture, and in some not much faster.
TEST(PassivitySettings, AWrenchFollowsItsCurrentsNoSlowerThanTheSlowestChange) {
  const PenGeometry pen = load_pen("riffler");
  const haptics::Bounds slowest = slowest_change(pen, 100);
  stress::Random random(3);
  const PenKinematics kinematics(pen);
  double force = kInfinity, torque = kInfinity;  // per s
  for (int n = 0; n < 20'000; ++n) {
    const PenPosture posture = kinematics.posture(random_angles(pen, random));
    const Vec3 f = random.direction();  // of the force, or at right angles to a grip of any direction
    for (const bool turns : {false, true}) {
      // 1 N on the hand, or 1 N·mm
      double farthest = 0;
      for (const PenChannel& c : pen.channels) {
        const double sign = c.arm == Arm::R ? 1 : -1;
        const Vec3 end = turns ? sign / pen.grip_length * f : 0.5 * f;
        const double joint = glm::dot(posture.arms[index(c.arm)].jacobian[c.joint], end);
        farthest = std::max(farthest, std::abs(joint) / (c.torque_constant * c.ratio));
      }
      double& least = turns ? torque : force;
      least = std::min(least, 100 / farthest);
    }
  }
  EXPECT_GE(force, slowest.linear);
  EXPECT_LT(force, 1.6 * slowest.linear);
  EXPECT_GE(torque, slowest.angular);
  EXPECT_LT(torque, 1.6 * slowest.angular);
}

/// By hand: an arm that is as straight as its elbow lets it be, 8.75 · 1.5 N·mm about the upright axis.
TEST(PassivitySettings, FrictionOfTheShippedPenIsThatAboutTheUprightAxisOfTheStretchedArm) {
  const double reach = std::sqrt(2 * 180 * 180 * (1 + std::sin(1.2)));
  EXPECT_NEAR(passivity_settings(load_pen("riffler")).device_friction.linear, 13.125 / reach / std::sqrt(3), 1e-12);
}

}  // namespace
}  // namespace riffler::pen::passivity_settings_test
