#include "pen/grip_turn.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/math.hpp"
#include "stress/random.hpp"

namespace riffler::pen::grip_turn_test {
namespace {

UnitQuaternion turn_by(const Vec3& axis, double angle) {
  return {std::cos(angle / 2), std::sin(angle / 2) * axis};
}

Vec3 any_direction(stress::Random& random) {
  return glm::normalize(Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) + Vec3(1e-9));
}

TEST(GripTurn, AQuaternionRotatesAsItsMatrixForEveryRotation) {
  stress::Random random(6);
  for (int k = 0; k < 20'000; ++k) {
    // Also half turns, where the trace is least.
    const double angle = k % 3 == 0 ? kPi : random.uniform(-kPi, kPi);
    const Vec3 axis = k % 5 == 0 ? Vec3(k % 2, 1 - k % 2, 0) : any_direction(random);
    const UnitQuaternion q = turn_by(axis, angle);
    const Mat3 columns(rotated(q, {1, 0, 0}), rotated(q, {0, 1, 0}), rotated(q, {0, 0, 1}));
    for (int j = 0; j < 3; ++j) {
      Vec3 unit(0);
      unit[j] = 1;
      EXPECT_LT(glm::length(geom::rotate_about(unit, axis, angle) - columns[j]), 1e-12);
    }
    const UnitQuaternion back = quaternion_of(columns);
    EXPECT_NEAR(back.w * back.w + glm::dot(back.v, back.v), 1, 1e-12);
    EXPECT_NEAR(std::abs(back.w * q.w + glm::dot(back.v, q.v)), 1, 1e-12) << k;
  }
}

TEST(GripTurn, TheFirstOrientationHasNoRate) {
  PenSample sample;
  sample.turning = Vec3(7);
  GripTurn turn({0, 0, 1}, 0.01);
  turn.turn(turn_by({1, 0, 0}, kPi / 2), 5, sample);
  EXPECT_LT(glm::length(sample.pose.axis - Vec3(0, -1, 0)), 1e-12);
  EXPECT_EQ(sample.turning, Vec3(0));
  EXPECT_EQ(sample.spin, 0);
  turn.turn(turn_by({0, 0, 1}, 0), 5, sample);
  EXPECT_EQ(sample.turning, Vec3(0)) << "no time has passed";
  turn.begin();
  turn.turn(turn_by({0, 0, 1}, 0.3), 6, sample);
  EXPECT_EQ(sample.turning, Vec3(0));
  EXPECT_NEAR(sample.spin, 0.3, 1e-12);
}

/// A steady rotation about any axis: the rate is that axis times the speed.
TEST(GripTurn, TheRateIsThatOfARigidBody) {
  stress::Random random(9);
  for (int round = 0; round < 50; ++round) {
    const Vec3 about = any_direction(random), own = any_direction(random);
    // Where the twist has no meaning, or the axis does not move, the parts differ: stay away from half a turn.
    GripTurn turn(own, 0.005);
    PenSample sample;
    for (int k = 0; k <= 100; ++k) turn.turn(turn_by(about, 0.01 * k), 1e-3 * k, sample);
    const Vec3 axis = sample.pose.axis;
    const Vec3 across = 10.0 * (about - glm::dot(about, axis) * axis);
    EXPECT_LT(glm::length(sample.turning - glm::dot(sample.turning, axis) * axis - across), 0.6) << round;
  }
}

TEST(GripTurn, BothSignsOfAQuaternionAreOneOrientation) {
  GripTurn turn({0, 0, 1}, 0.005);
  PenSample sample;
  for (int k = 0; k <= 2000; ++k) {
    UnitQuaternion q = turn_by({0, 0, 1}, 0.01 * k);
    if (k % 2 == 1) q = {-q.w, -q.v};
    turn.turn(q, 1e-3 * k, sample);
  }
  EXPECT_NEAR(sample.spin, 20, 1e-9);
  EXPECT_LT(glm::length(sample.turning - Vec3(0, 0, 10)), 1e-6);
}

}  // namespace
}  // namespace riffler::pen::grip_turn_test
