// Speeds from counters: as smooth as the motion is steady, as quick as it changes.
#include "pen/arms/count_speed.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/pens.hpp"

namespace riffler::pen::count_speed_test {
namespace {

constexpr double kCount = 2 * kPi / 48000;  // rad, of joint 2 of R: channel 0

EncoderCounts at(double count, std::int32_t start = 0) {
  const auto whole = static_cast<std::int64_t>(std::floor(count));
  return {static_cast<std::int32_t>(static_cast<std::uint32_t>(start) + static_cast<std::uint32_t>(whole))};
}

TEST(CountSpeed, SteadyMotionIsAveragedOverTheWholeWindow) {
  stress::Random random(51);
  for (int round = 0; round < 500; ++round) {
    const double speed = random.sign() * random.power_of_ten(0, 6), from = random.uniform(0, 1);  // counts/s
    CountSpeed estimate(load_pen("riffler"));
    for (int k = 0; k < 60; ++k) estimate.add(at(from + speed * 0.001 * k), 0.001 * k);
    EXPECT_LT(std::abs(estimate.rates()[0].y / kCount - speed), 1 / 0.019) << "a count over 19 ms";
  }
}

TEST(CountSpeed, ATremblingCountGivesNearlyNoSpeed) {
  CountSpeed estimate(load_pen("riffler"));
  double most = 0;
  for (int k = 0; k < 200; ++k) {
    estimate.add(at(k % 2), 0.001 * k);
    if (k > 20) most = std::max(most, std::abs(estimate.rates()[0].y / kCount));
  }
  EXPECT_LT(most, 60);
}

TEST(CountSpeed, AStopIsFollowedWithinMilliseconds) {
  CountSpeed estimate(load_pen("riffler"));
  double count = 0;
  for (int k = 0; k < 100; ++k) estimate.add(at(count += 20), 0.001 * k);
  EXPECT_NEAR(estimate.rates()[0].y / kCount, 20000, 60);
  for (int k = 100; k < 103; ++k) estimate.add(at(count), 0.001 * k);
  EXPECT_EQ(estimate.rates()[0].y, 0);
}

TEST(CountSpeed, AcceleratedMotionIsFollowed) {
  // Half a turn of the joint per second and second.
  CountSpeed estimate(load_pen("riffler"));
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.001 * k;
    estimate.add(at(12000 * t * t), t);
    if (k > 20) worst = std::max(worst, std::abs(estimate.rates()[0].y / kCount - 24000 * t));
  }
  EXPECT_LT(worst, 500) << "2 % of the full speed; a plain difference would be off by 1000";
}

TEST(CountSpeed, WrappingCountersAndTimesThatJumpBackHaveNoEffect) {
  const std::int32_t most = std::numeric_limits<std::int32_t>::max();
  CountSpeed plain(load_pen("riffler")), wrapping(load_pen("riffler"));
  for (int k = 0; k < 50; ++k) {
    plain.add(at(7.0 * k), 0.001 * k);
    wrapping.add(at(7.0 * k, most - 150), 0.001 * k);
    wrapping.add(at(-1e6), 0.001 * k);
    wrapping.add(at(-1e6), 0.0005 * k);
    wrapping.add(at(-1e6), std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_EQ(plain.rates(), wrapping.rates());
  EXPECT_NEAR(plain.rates()[0].y / kCount, 7000, 1e-6);
  wrapping.clear();
  EXPECT_EQ(wrapping.rates(), JointAngles{});
}

TEST(CountSpeed, EachChannelIsItsJoints) {
  CountSpeed estimate(load_pen("riffler"));
  for (int k = 0; k < 30; ++k) estimate.add({10 * k, 20 * k, 35 * k, 0, -20 * k, -35 * k}, 0.001 * k);
  const double s = 2 * kPi;
  const JointAngles rates = estimate.rates();
  EXPECT_LT(glm::distance(rates[0], s * Vec3(0.5, 10.0 / 48, 20.0 / 48)), 1e-9);
  EXPECT_LT(glm::distance(rates[1], s * Vec3(-0.5, 0, -20.0 / 48)), 1e-9);
}

}  // namespace
}  // namespace riffler::pen::count_speed_test
