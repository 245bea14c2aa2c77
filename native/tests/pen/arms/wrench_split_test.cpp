// The force split: nothing of a wrench is lost but what the grip cannot bear.
#include "pen/arms/wrench_split.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/pens.hpp"

namespace riffler::pen::wrench_split_test {
namespace {

constexpr double kEps = 0x1p-52;

/// The force along the grip with which the arms pull it apart (positive) or squeeze it; the hand feels nothing of it.
double tension(const ArmForces& forces, const Vec3& apart) {
  return 0.5 * glm::dot(forces[index(Arm::L)] - forces[index(Arm::R)], apart) / glm::length(apart);
}

TEST(WrenchSplit, SumAndMomentAreExactForAMillionWrenches) {
  stress::Random random(21);
  double worst_sum = 0, worst_moment = 0, worst_squeeze = 0;
  for (int k = 0; k < 1000000; ++k) {
    const Vec3 apart = random.power_of_ten(-1, 3) * random.direction();
    const Wrench wrench{random.power_of_ten(-3, 3) * random.direction(),
                        random.power_of_ten(-3, 5) * random.direction()};
    const WrenchSplit split = split_wrench(wrench, apart);
    const double arms = glm::length(split.forces[0]) + glm::length(split.forces[1]), r = glm::length(apart);
    const Vec3 along = apart / r;
    // Moments of the two forces about the grip's middle, each by its own lever.
    const Vec3 moment = glm::cross(-0.5 * apart, split.forces[0]) + glm::cross(0.5 * apart, split.forces[1]);
    const Vec3 borne = wrench.torque - glm::dot(wrench.torque, along) * along;
    worst_sum = std::max(worst_sum, glm::distance(split.forces[0] + split.forces[1], wrench.force) / arms);
    worst_moment = std::max(worst_moment, glm::distance(moment, borne) / (arms * r + glm::length(wrench.torque)));
    worst_moment = std::max(
        worst_moment, glm::distance(moment + split.missing, wrench.torque) / (arms * r + glm::length(wrench.torque)));
    worst_squeeze = std::max(worst_squeeze, std::abs(tension(split.forces, apart)) / arms);
  }
  EXPECT_LE(worst_sum, 2 * kEps);
  EXPECT_LE(worst_moment, 4 * kEps);
  EXPECT_LE(worst_squeeze, 8 * kEps) << "the least forces do not squeeze the grip";
}

TEST(WrenchSplit, OfArmForcesGivesThemBackExceptForTheirTension) {
  stress::Random random(22);
  for (int k = 0; k < 10000; ++k) {
    const Vec3 apart = 30.0 * random.direction();
    const ArmForces forces{5.0 * random.direction(), 3.0 * random.direction()};
    const double pull = tension(forces, apart);
    const WrenchSplit split = split_wrench(wrench_of(forces, apart), apart);
    EXPECT_LT(glm::length(split.missing), 1e-12);
    EXPECT_LT(glm::distance(split.forces[0], forces[0] + pull * apart / 30.0), 1e-13);
    EXPECT_LT(glm::distance(split.forces[1], forces[1] - pull * apart / 30.0), 1e-13);
  }
}

TEST(WrenchSplit, AllTorqueAlongTheGripIsMissing) {
  const WrenchSplit split = split_wrench({{0, 0, 0}, {0, 0, 50}}, {0, 0, -30});
  EXPECT_EQ(split.missing, Vec3(0, 0, 50));
  EXPECT_EQ(split.forces[0], Vec3(0));
  EXPECT_EQ(split.forces[1], Vec3(0));
}

TEST(WrenchSplit, TheSourcesCoupleIsTooStrongAndOursIsNot) {
  // τ at 60° to the grip: half of it lies along.
  const Vec3 apart(0, 0, 30), torque(60 * std::sqrt(0.75), 0, 30);
  const WrenchSplit split = split_wrench({Vec3(0), torque}, apart);
  EXPECT_NEAR(glm::length(split.forces[1]), 60 * std::sqrt(0.75) / 30, 1e-15) << "printed: |τ| / |r| = 2";
  EXPECT_LT(glm::distance(wrench_of(split.forces, apart).torque, Vec3(torque.x, 0, 0)), 1e-14);
}

TEST(WrenchSplit, ZeroAndTinyGripsAreFinite) {
  const Wrench wrench{{1, 2, 3}, {4, 5, 6}};
  const WrenchSplit none = split_wrench(wrench, Vec3(0));
  EXPECT_EQ(none.missing, wrench.torque);
  EXPECT_EQ(none.forces[0] + none.forces[1], wrench.force);
  const WrenchSplit tiny = split_wrench({wrench.force, 1e-200 * wrench.torque}, {1e-150, 0, 0});
  EXPECT_TRUE(geom::finite(tiny.forces[0]) && geom::finite(tiny.forces[1]) && geom::finite(tiny.missing));
}

TEST(WrenchSplit, EffortDoesTheWorkOfTheWrenchAtItsPoint) {
  const PenKinematics pen(test::turned_pen());
  stress::Random random(23);
  int reached = 0;
  for (int k = 0; k < 5000; ++k) {
    const Pose pose = test::random_pose(random, pen.geometry());
    const PenInverse inverse = pen.inverse(pose);
    if (!inverse.reached()) continue;
    ++reached;
    const PenPosture posture = pen.posture(inverse.angles);
    const Vec3 tip = pose.tip - 60.0 * pose.axis;
    const Wrench wrench{4.0 * random.direction(), 50.0 * random.direction()};
    const PenEffort effort = pen_effort(pen, posture, wrench, tip);
    EXPECT_NEAR(std::abs(glm::dot(effort.missing, pose.axis)), glm::length(effort.missing), 1e-12);
    // Motions of a rigid grip: angles of nearby poses. The grip's rotation about itself does not show, so the work of
    // torque about it is the missing one.
    const Vec3 moved = 1e-4 * random.direction(), turned = 1e-5 * random.square_to(pose.axis);
    const auto at = [&](double t) {
      return pen.inverse({pose.tip + t * moved, glm::normalize(pose.axis + t * glm::cross(turned, pose.axis))});
    };
    const PenInverse after = at(1), before = at(-1);
    double work = 0;
    for (std::size_t arm = 0; arm < 2; ++arm)
      work += glm::dot(effort.torques[arm], after.angles[arm] - before.angles[arm]);
    const Vec3 tip_moved = moved + glm::cross(turned, tip - pose.tip);
    const double given = 2 * (glm::dot(wrench.force, tip_moved) + glm::dot(wrench.torque, turned));
    EXPECT_NEAR(work, given, 1e-8);
  }
  EXPECT_GT(reached, 1000);
}

TEST(WrenchSplit, TheFeltWrenchIsTheRequestedOneLessTheMissingPart) {
  stress::Random random(47);
  int round = 0;
  while (round < 2000) {
    const PenGeometry geometry = round % 2 ? test::turned_pen() : load_pen("riffler");
    const PenKinematics pen(geometry);
    const PenInverse found = pen.inverse(test::random_pose(random, geometry));
    if (!found.reached()) continue;
    ++round;
    const PenPosture posture = pen.posture(found.angles);
    const Wrench asked{5.0 * random.direction(), 80.0 * random.direction()};
    const PenEffort effort = pen_effort(pen, posture, asked, posture.pose.tip);
    const Wrench felt = felt_wrench(pen, posture, effort.torques);
    EXPECT_LT(glm::length(felt.force - asked.force), 1e-10);
    EXPECT_LT(glm::length(felt.torque + effort.missing - asked.torque), 1e-9);
  }
  // A straight arm could bear any force; felt_wrench counts none.
  const PenKinematics pen(load_pen("riffler"));
  const PenPosture straight = pen.posture(JointAngles{Vec3(0, 0, -1.5707963267948966), Vec3(0, 0.3, 0.1)});
  const Wrench felt = felt_wrench(pen, straight, {Vec3(5, 5, 5), Vec3(0)});
  EXPECT_EQ(felt.force, Vec3(0));
}

}  // namespace
}  // namespace riffler::pen::wrench_split_test
