// A weight on a thread, against the closed forms of a hanging mass and of a pendulum; and pens drawn at random.
#include "pen/simulated/simulated_weight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geom/math.hpp"
#include "pen/simulated/random_pen.hpp"
#include "support/error_of.hpp"
#include "support/pens.hpp"

namespace riffler::pen::simulated_weight_test {
namespace {

constexpr double kStep = 1.25e-4;

TEST(SimulatedWeight, AtRestPullsDownWithItsWeightAtItsHook) {
  const PenGeometry geometry = test::turned_pen();  // down is not −z there
  const PenKinematics pen(geometry);
  PenPosture posture = pen.posture(pen.home_angles());
  SimulatedWeight weight;
  EXPECT_EQ(weight.pull(pen, posture, {}, kStep).force, Vec3(0));
  weight.hang(0.2, 15);
  Wrench w;
  for (int k = 0; k < 8000; ++k) w = weight.pull(pen, posture, {}, kStep);
  const Vec3 down = 0.2 * kStandardGravity * pen.from_base(Vec3(0, 0, -1));
  EXPECT_LT(glm::distance(w.force, down), 1e-6);
  EXPECT_LT(glm::distance(w.torque, glm::cross(-15.0 * posture.pose.axis, down)), 1e-4);
  weight.hang(0, 15);
  EXPECT_EQ(weight.pull(pen, posture, {}, kStep).force, Vec3(0));
}

/// After its point has jumped aside by 3 mm it swings with 2π √(l/g) of the thread and what that gives.
TEST(SimulatedWeight, SwingsLikeAPendulum) {
  const PenKinematics pen(load_pen("riffler"));
  PenPosture posture = pen.posture(pen.home_angles());
  SimulatedWeight weight;
  weight.hang(0.2, 0);
  weight.pull(pen, posture, {}, kStep);
  posture.pose.tip.x += 3;
  std::vector<double> crossings;
  double last = weight.pull(pen, posture, {}, kStep).force.x;
  for (int k = 1; k < 40'000; ++k) {
    const double now = weight.pull(pen, posture, {}, kStep).force.x;
    if (last < 0 && now >= 0) crossings.push_back(k * kStep);
    last = now;
  }
  ASSERT_GT(crossings.size(), 5U);
  const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  EXPECT_NEAR(period, kTwoPi * std::sqrt(61e-3 / kStandardGravity), 0.005);
}

TEST(SimulatedWeight, RefusesImpossibleWeights) {
  SimulatedWeight weight;
  EXPECT_NE(test::error_of([&] { weight.hang(-1, 0); }).find("mass"), std::string::npos);
  EXPECT_NE(test::error_of([&] { weight.hang(1, std::numeric_limits<double>::infinity()); }).find("hook"),
            std::string::npos);
  EXPECT_EQ(weight.mass(), 0);
}

TEST(RandomPen, IsTheSameForASeedAndDiffersOnlyWhereItIsDrawn) {
  const PenGeometry pen = load_pen("riffler"), one = random_pen(pen, 1), again = random_pen(pen, 1),
                    two = random_pen(pen, 2);
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel &a = pen.channels[k], &b = one.channels[k];
    EXPECT_EQ(b.torque_constant, again.channels[k].torque_constant);
    EXPECT_NE(b.torque_constant, two.channels[k].torque_constant);
    EXPECT_NE(b.torque_constant, a.torque_constant);
    EXPECT_NEAR(b.torque_constant / a.torque_constant, 1, 0.15);
    EXPECT_NEAR(b.coulomb / a.coulomb, 1.05, 0.45);
    EXPECT_NEAR(b.viscous / a.viscous, 1.05, 0.45);
    EXPECT_EQ(b.gravity == 0, a.joint == 0);
    EXPECT_EQ(b.steps, a.steps);
    EXPECT_EQ(b.home, a.home);
  }
  EXPECT_EQ(one.grip_length, pen.grip_length);
}

}  // namespace
}  // namespace riffler::pen::simulated_weight_test
