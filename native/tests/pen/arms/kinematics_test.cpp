// The whole pen: counters to poses and back, speeds, homing, wraps.
#include "riffler/pen/arms/kinematics.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <type_traits>
#include <utility>

#include "pen/arms/pens.hpp"
#include "support/pens.hpp"

namespace riffler::pen::kinematics_test {
namespace {

using test::random_pose;

/// Calls for the poses that are in reach and within the limits, and sees to it that some are.
void for_reached(int poses, const PenKinematics& pen, const std::function<void(const Pose&, const PenInverse&)>& call) {
  stress::Random random(11);
  int reached = 0;
  for (int k = 0; k < poses; ++k) {
    const Pose pose = random_pose(random, pen.geometry());
    const PenInverse inverse = pen.inverse(pose);
    if (inverse.reached()) ++reached, call(pose, inverse);
  }
  EXPECT_GT(reached, poses / 4);
}

TEST(PenKinematics, HomeAgreesWithTheSource) {
  const PenKinematics pen(load_pen("riffler"));
  const PenPosture home = pen.posture(EncoderCounts{0, 0, -5133, 0, 0, 5133});
  // Exactly at arcsin(L0 / L2), whose count the source has as 5133 and is 5130.96, the ends would be at y = 0.
  const double first = 5133 * 2 * kPi / 70000, out = 180 * std::cos(first), beside = 80 - 180 * std::sin(first);
  EXPECT_LT(glm::distance(home.arms[0].end, Vec3(out, beside, -150)), 1e-12);
  EXPECT_LT(glm::distance(home.arms[1].end, Vec3(out, -beside, -180)), 1e-12);
  EXPECT_NEAR(home.length, std::hypot(30.0, 2 * beside), 1e-12);
  EXPECT_NEAR(home.length, 30, 1e-4);
  EXPECT_LT(glm::distance(home.pose.tip, Vec3(out, 0, -165)), 1e-12);
  EXPECT_GT(home.pose.axis.z, 0.99999) << "from the tip, down at the left arm's end, upwards";
  EXPECT_NEAR(std::asin(80.0 / 180) * 70000 / (2 * kPi), 5130.96, 0.005);
}

TEST(PenKinematics, AnglesAreCountsByStepsOfTheirJoint) {
  const PenKinematics pen(load_pen("riffler"));
  const JointAngles angles = pen.angles({48000, 12000, 35000, -48000, -12000, -7000});
  EXPECT_LT(glm::distance(angles[0], Vec3(kPi, 2 * kPi, kPi / 2)), 1e-14);
  EXPECT_LT(glm::distance(angles[1], Vec3(-kPi / 5, -2 * kPi, -kPi / 2)), 1e-14);
}

TEST(PenKinematics, PosesAreRestoredFromTheirAngles) {
  const PenKinematics pen(test::turned_pen());
  for_reached(20000, pen, [&](const Pose& pose, const PenInverse& inverse) {
    const PenPosture posture = pen.posture(inverse.angles);
    EXPECT_LT(glm::distance(posture.pose.tip, pose.tip), 1e-10);
    EXPECT_LT(glm::distance(posture.pose.axis, pose.axis), 1e-10);
    EXPECT_NEAR(posture.length, pen.geometry().grip_length, 1e-10);
  });
}

TEST(PenKinematics, PosesAreRestoredFromTheirCountsToHalfACount) {
  const PenKinematics pen(load_pen("riffler"));
  double furthest = 0;
  for_reached(20000, pen, [&](const Pose& pose, const PenInverse& inverse) {
    const PenPosture posture = pen.posture(pen.counts(inverse.angles));
    furthest = std::max(furthest, glm::distance(posture.pose.tip, pose.tip));
    for (std::size_t arm = 0; arm < 2; ++arm)
      for (int k = 0; k < 3; ++k)
        EXPECT_LE(std::abs(posture.angles[arm][k] - inverse.angles[arm][k]), (k ? kPi / 48000 : kPi / 70000) + 1e-12);
  });
  // Half a count each: 330 mm of arm by π / 70000, 150 and 180 mm by π / 48000; the middle moves as the ends' mean.
  EXPECT_LT(furthest, 330 * kPi / 70000 + 360 * kPi / 48000);
  EXPECT_GT(furthest, 0.005);
}

TEST(PenKinematics, InverseNamesTheArmThatCannotReachAndTheReason) {
  const PenKinematics pen(load_pen("riffler"));
  const Pose home = pen.posture(pen.home_angles()).pose;
  EXPECT_TRUE(pen.inverse(home).reached());
  const PenInverse far = pen.inverse({{345, 0, 0}, {0, 0, 1}});
  EXPECT_EQ(far.reach[0], ReachResult::TooFar);
  EXPECT_EQ(far.reach[1], ReachResult::Limits) << "its arm is longer";
  EXPECT_EQ(pen.inverse({home.tip + Vec3(0, 0, 200), home.axis}).reach[0], ReachResult::Limits);
  EXPECT_EQ(pen.inverse({{0, -80, -185}, {0, 0, 1}}).reach[1], ReachResult::OnAxis);
  EXPECT_EQ(pen.inverse({home.tip, Vec3(0)}).reach[0], ReachResult::NotFinite);
  EXPECT_EQ(pen.inverse({home.tip, Vec3(std::numeric_limits<double>::quiet_NaN())}).reach[1], ReachResult::NotFinite);
}

TEST(PenKinematics, SpeedIsTheDerivativeOfThePose) {
  const PenKinematics pen(test::turned_pen());
  stress::Random random(12);
  constexpr double kStep = 1e-5;
  for_reached(2000, pen, [&](const Pose&, const PenInverse& inverse) {
    const JointAngles rates{2.0 * random.direction(), 2.0 * random.direction()};
    const auto at = [&](double t) {
      return pen.posture(JointAngles{inverse.angles[0] + t * rates[0], inverse.angles[1] + t * rates[1]});
    };
    const PenPosture now = at(0), before = at(-kStep), after = at(kStep);
    const PenSpeed speed = pen.speed(now, rates);
    EXPECT_LT(glm::distance(speed.twist.linear, (after.pose.tip - before.pose.tip) / (2 * kStep)), 1e-4);
    const Vec3 turning = (after.pose.axis - before.pose.axis) / (2 * kStep);
    EXPECT_LT(glm::distance(glm::cross(speed.twist.angular, now.pose.axis), turning), 1e-4);
    EXPECT_NEAR(glm::dot(speed.twist.angular, now.pose.axis), 0, 1e-12);
    EXPECT_NEAR(speed.stretch, (after.length - before.length) / (2 * kStep), 1e-4);
  });
}

TEST(PenKinematics, AnyStartOfTheCountersGivesTheSamePoses) {
  PenKinematics preset(load_pen("riffler")), homed(load_pen("riffler"));
  constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max(), kMin = -kMax - 1;
  const EncoderCounts starts{kMax, kMin, kMax - 10, kMin + 10, 0, 123456789};
  homed.home_at(starts, kMax);
  const EncoderCounts home{0, 0, -5133, 0, 0, 5133};
  stress::Random random(13);
  for (int k = 0; k < 2000; ++k) {
    EncoderCounts counts{}, raw{};
    for (std::size_t j = 0; j < kPenChannels; ++j) {
      const std::int32_t moved = random.below(40000) - 20000;
      counts[j] = home[j] + moved;
      raw[j] = static_cast<std::int32_t>(static_cast<std::uint32_t>(starts[j]) + static_cast<std::uint32_t>(moved));
    }
    EXPECT_EQ(preset.angles(counts), homed.angles(raw)) << "past the counters' ends";
    EXPECT_EQ(homed.counts(homed.angles(raw)), raw);
    EXPECT_EQ(homed.preset(raw), counts);
    EXPECT_EQ(preset.counts(preset.angles(counts)), counts);
  }
  EXPECT_EQ(homed.probe_angle(kMin), preset.probe_angle(1));
}

TEST(PenKinematics, ProbeTurnsAddUp) {
  const PenKinematics pen(load_pen("riffler"));
  EXPECT_NEAR(pen.probe_angle(2000), 5 * kPi, 1e-12);
  EXPECT_NEAR(pen.probe_angle(-200), -kPi / 2, 1e-12);
  EXPECT_EQ(pen.probe_count(5 * kPi), 2000);
}

TEST(PenKinematics, SignsOfCountersTurnTheirJoints) {
  PenGeometry geometry = load_pen("riffler");
  const PenKinematics plain(geometry);
  for (PenChannel& c : geometry.channels) c.sign = -1, c.home = -c.home;
  const PenKinematics mirrored(geometry);
  const EncoderCounts counts{100, 200, -300, 400, 500, 600};
  EncoderCounts other{};
  for (std::size_t k = 0; k < kPenChannels; ++k) other[k] = -counts[k];
  EXPECT_EQ(plain.angles(counts), mirrored.angles(other));
}

TEST(PenKinematics, CoincidingEndsHaveNoDirectionAndAllValuesAreFinite) {
  PenGeometry geometry = load_pen("riffler");
  geometry.arms[1] = geometry.arms[0];
  const PenKinematics pen(geometry);
  const JointAngles same{Vec3(0.1, 0.2, 0.3), Vec3(0.1, 0.2, 0.3)};
  const PenPosture posture = pen.posture(same);
  EXPECT_EQ(posture.length, 0);
  EXPECT_EQ(posture.pose.axis, Vec3(0));
  const PenSpeed speed = pen.speed(posture, {Vec3(1), Vec3(2)});
  EXPECT_TRUE(finite(speed.twist));
}

TEST(PenKinematics, CallsOfAHapticStepThrowNothingAndAllocateNothing) {
  static_assert(noexcept(std::declval<const PenKinematics&>().posture(std::declval<const EncoderCounts&>())));
  static_assert(noexcept(std::declval<const PenKinematics&>().inverse(std::declval<const Pose&>())));
  static_assert(std::is_trivially_copyable_v<PenPosture> && std::is_trivially_copyable_v<PenInverse>);
  EXPECT_EQ(within_a_turn(-kPi), kPi);
  EXPECT_NEAR(within_a_turn(7), 7 - 2 * kPi, 1e-15);
}

}  // namespace
}  // namespace riffler::pen::kinematics_test
