// One arm: its posture against products of rotations, its Jacobian against differences and virtual work, its inverse.
#include "riffler/pen/arms/arm.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stress/random.hpp"

namespace riffler::pen::arm_test {
namespace {

constexpr ArmLinks kRight{80, 150, 180}, kLeft{-80, 180, 180};

Vec3 random_angles(stress::Random& random) {
  return {random.uniform(-kPi, kPi), random.uniform(-kPi, kPi), random.uniform(-kPi, kPi)};
}

Mat3 about_y(double angle) {
  return Mat3(Vec3(std::cos(angle), 0, -std::sin(angle)), Vec3(0, 1, 0), Vec3(std::sin(angle), 0, std::cos(angle)));
}

Mat3 about_z(double angle) {
  return Mat3(Vec3(std::cos(angle), std::sin(angle), 0), Vec3(-std::sin(angle), std::cos(angle), 0), Vec3(0, 0, 1));
}

/// The chain as built: turn about the upright, then each link turned about the arm's level cross axis (forwards
/// is about −y), each from its own zero, hanging and level, since a parallelogram keeps the fore arm's direction.
Vec3 end_by_chain(const ArmLinks& links, const Vec3& angles) {
  const Vec3 upper = about_y(-angles.y) * Vec3(0, 0, -links.upper), fore = about_y(-angles.z) * Vec3(links.fore, 0, 0);
  return Vec3(0, links.shoulder, 0) + about_z(angles.x) * (upper + fore);
}

TEST(PenArm, EndIsThatOfTheChainOfRotations) {
  stress::Random random(1);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 angles = random_angles(random);
    for (const ArmLinks& links : {kRight, kLeft})
      EXPECT_LT(glm::distance(arm_posture(links, angles).end, end_by_chain(links, angles)), 4e-13);
  }
}

TEST(PenArm, JacobianIsTheDerivativeOfTheEnd) {
  stress::Random random(2);
  constexpr double kStep = 1e-4;  // error of the difference: L h² / 6 = 3e-7 mm per rad
  for (int k = 0; k < 20000; ++k) {
    const Vec3 angles = random_angles(random);
    for (const ArmLinks& links : {kRight, kLeft}) {
      const Mat3 jacobian = arm_posture(links, angles).jacobian;
      for (int j = 0; j < 3; ++j) {
        Vec3 step(0);
        step[j] = kStep;
        const Vec3 slope = (end_by_chain(links, angles + step) - end_by_chain(links, angles - step)) / (2 * kStep);
        EXPECT_LT(glm::distance(jacobian[j], slope), 1e-6) << "joint " << j + 1;
      }
    }
  }
}

TEST(PenArm, SecondRowOfTheSourcesJacobianIsWrongAndOursIsNot) {
  const Vec3 angles(0.3, -0.4, 0.5);
  const Mat3 jacobian = arm_posture(kRight, angles).jacobian;
  EXPECT_NEAR(jacobian[2][1], -180 * std::sin(0.3) * std::sin(0.5), 1e-12);
  EXPECT_GT(std::abs(jacobian[2][1] + 180 * std::sin(-0.4) * std::sin(0.5)), 50) << "as (2.7) is printed";
}

TEST(PenArm, JointTorquesDoTheWorkOfTheForce) {
  stress::Random random(3);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 angles = random_angles(random), force = random.power_of_ten(-2, 2) * random.direction();
    const Vec3 turn = 1e-4 * random.direction();
    const Vec3 torque = joint_torques(arm_posture(kLeft, angles), force);
    const Vec3 moved = end_by_chain(kLeft, angles + turn) - end_by_chain(kLeft, angles - turn);
    EXPECT_NEAR(glm::dot(torque, 2.0 * turn), glm::dot(force, moved), 1e-9 * glm::length(force));
  }
}

TEST(PenArm, DexterityIsTheJacobiansDeterminant) {
  stress::Random random(4);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 angles = random_angles(random);
    EXPECT_NEAR(arm_dexterity(kRight, angles),
                -glm::determinant(arm_posture(kRight, angles).jacobian) / (150.0 * 180.0 * 330.0), 1e-14);
  }
}

TEST(PenArm, InverseBringsTheEndBack) {
  stress::Random random(5);
  for (int k = 0; k < 50000; ++k)
    for (const ArmLinks& links : {kRight, kLeft}) {
      const double elbow = random.uniform(-kPi / 2, kPi / 2), third = random.uniform(-kPi, kPi);
      const Vec3 angles(random.uniform(-kPi, kPi), third + elbow, third);
      const Vec3 end = end_by_chain(links, angles);
      const ArmInverse found = arm_angles(links, end);
      ASSERT_EQ(found.reach, ReachResult::Reached);
      EXPECT_LT(glm::distance(end_by_chain(links, found.angles), end), 1e-9);
      // The arm that reaches over its own upright axis is another answer, the same end.
      if (arm_dexterity(links, angles) < 1e-3) continue;
      for (int j = 0; j < 3; ++j) {
        EXPECT_NEAR(std::remainder(found.angles[j] - angles[j], 2 * kPi), 0, 1e-9) << "joint " << j + 1;
      }
    }
}

TEST(PenArm, InverseKeepsItsDigitsWhereTheArmIsNearlyStraightOrFolded) {
  for (const ArmLinks& links : {kRight, kLeft})
    for (const double side : {1.0, -1.0})
      for (const double from : {1e-1, 1e-3, 1e-5, 1e-7}) {
        const double third = links.upper == links.fore && side < 0 ? 0.0 : 0.2;
        const Vec3 angles(0.1, third + side * (kPi / 2 - from), third);
        const Vec3 end = end_by_chain(links, angles);
        const ArmInverse found = arm_angles(links, end);
        if (found.reach == ReachResult::TooFar || found.reach == ReachResult::TooNear)
          continue;  // by the end's own rounding
        EXPECT_LT(glm::distance(end_by_chain(links, found.angles), end), 1e-11) << from << " " << side;
      }
}

TEST(PenArm, InverseNamesTheReasonIfThereIsNone) {
  const auto reach = [](const ArmLinks& links, const Vec3& from_shoulder) {
    return arm_angles(links, from_shoulder + Vec3(0, links.shoulder, 0)).reach;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(reach(kRight, {330.001, 0, 0}), ReachResult::TooFar);
  EXPECT_EQ(reach(kRight, {329.999, 0, 0}), ReachResult::Reached);
  EXPECT_EQ(reach(kRight, {29.999, 0, 0}), ReachResult::TooNear);
  EXPECT_EQ(reach(kRight, {30.001, 0, 0}), ReachResult::Reached);
  EXPECT_EQ(reach(kRight, {0, 0, -200}), ReachResult::OnAxis);
  EXPECT_EQ(reach(kLeft, {0, 0, 0}), ReachResult::OnAxis) << "folded on itself";
  EXPECT_EQ(reach(kLeft, {1e-3, 0, 0}), ReachResult::Reached);
  EXPECT_EQ(reach(kRight, {nan, 0, 0}), ReachResult::NotFinite);
  EXPECT_EQ(reach(kRight, {0, 1.7e308, 1.7e308}), ReachResult::NotFinite) << "its distance is not";
}

TEST(PenArm, BeyondItsReachTheArmPointsThere) {
  const Vec3 far(900, 300, -500);
  const ArmInverse found = arm_angles(kRight, far + Vec3(0, 80, 0));
  EXPECT_EQ(found.reach, ReachResult::TooFar);
  EXPECT_LT(glm::distance(end_by_chain(kRight, found.angles), 330.0 * glm::normalize(far) + Vec3(0, 80, 0)), 1e-9);
}

TEST(PenArm, SingularPosturesAreFinite) {
  for (const double third : {-kPi, -kPi / 2, 0.0, kPi / 2, kPi})
    for (const double elbow : {-kPi / 2, kPi / 2})
      for (const ArmLinks& links : {kRight, kLeft}) {
        const Vec3 angles(0.7, third + elbow, third);
        const ArmPosture posture = arm_posture(links, angles);
        EXPECT_TRUE(geom::finite(posture.end));
        EXPECT_TRUE(geom::finite(joint_torques(posture, {1, 2, 3})));
        EXPECT_LT(std::abs(arm_dexterity(links, angles)), 1e-15);
        EXPECT_TRUE(geom::finite(arm_angles(links, posture.end).angles));
      }
}

}  // namespace
}  // namespace riffler::pen::arm_test
