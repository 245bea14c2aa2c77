// Torques through gears to commands, weight and friction.
#include "riffler/pen/arms/motors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pen/arms/wrench_split.hpp"
#include "support/pens.hpp"

namespace riffler::pen::motors_test {
namespace {

TEST(PenMotors, GearsTakeTorqueAsTheyGiveTurns) {
  PenGeometry pen = load_pen("riffler");
  pen.channels[0].sign = -1;
  const MotorTorques motors = motor_torques(pen, {Vec3(105, 72, 36), Vec3(-105, -72, 0)});
  const MotorTorques expected{-12, 6, 12, -12, 0, -12};
  for (std::size_t k = 0; k < kPenChannels; ++k) EXPECT_NEAR(motors[k], expected[k], 1e-14) << k;
  const JointAngles back = joint_torques(pen, motors);
  EXPECT_LT(glm::distance(back[0], Vec3(105, 72, 36)) + glm::distance(back[1], Vec3(-105, -72, 0)), 1e-12);
}

TEST(PenMotors, CommandsAreCurrentsOrConvertersSteps) {
  PenGeometry pen = load_pen("riffler");
  pen.channels[1].torque_constant = 20;
  pen.converter->offset = {0, 0, 10, 0, 0, -3};
  const MotorTorques torques{30, 30, -60, 0, 0.01, 90};
  const MotorCommands currents = motor_currents(pen, torques);
  EXPECT_EQ(currents.scale, 1);
  EXPECT_EQ(currents.values, (std::array<std::int16_t, 6>{1000, 1500, -2000, 0, 0, 3000}));
  const MotorCommands steps = converter_steps(pen, *pen.converter, torques);
  EXPECT_EQ(steps.values, (std::array<std::int16_t, 6>{660, 660, -1310, 0, 0, 1977}));
}

TEST(PenMotors, BeyondAPeakAllAreScaledAndTheWrenchKeepsItsDirection) {
  const PenGeometry geometry = load_pen("riffler");
  const PenKinematics pen(geometry);
  const PenPosture home = pen.posture(pen.home_angles());
  const Wrench wrench{{20, -5, 60}, {100, 40, 0}};
  const PenEffort effort = pen_effort(pen, home, wrench, home.pose.tip);
  const MotorCommands commands = motor_currents(geometry, motor_torques(geometry, effort.torques));
  EXPECT_LT(commands.scale, 0.2);
  int at_peak = 0;
  MotorTorques given{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    EXPECT_LE(std::abs(commands.values[k]), 3000);
    at_peak += std::abs(commands.values[k]) == 3000;
    given[k] = commands.values[k] * geometry.channels[k].torque_constant / 1000;
  }
  EXPECT_EQ(at_peak, 1);
  // What the arms then push with, from the torques back through the Jacobians.
  const JointAngles torques = joint_torques(geometry, given);
  ArmForces forces{};
  for (std::size_t arm = 0; arm < 2; ++arm)
    forces[arm] = glm::inverse(glm::transpose(home.arms[arm].jacobian)) * torques[arm];
  const Wrench felt = wrench_of(forces, home.apart);
  EXPECT_LT(glm::distance(felt.force, commands.scale * wrench.force), 0.01) << "N: half a mA on each motor";
  const Vec3 missing = effort.missing;
  EXPECT_LT(glm::distance(felt.torque, commands.scale * (wrench.torque - missing)), 0.1);
}

TEST(PenMotors, NanTorquesPushNothing) {
  const PenGeometry pen = load_pen("riffler");
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MotorTorques torques{90, 90, 90, 90, 90, 90};
    torques[3] = bad;
    const MotorCommands commands = motor_currents(pen, torques);
    EXPECT_EQ(commands.scale, 0);
    EXPECT_EQ(commands.values, (std::array<std::int16_t, 6>{}));
    Converter converter = *pen.converter;
    converter.offset.fill(7);
    EXPECT_EQ(converter_steps(pen, converter, torques).values, (std::array<std::int16_t, 6>{7, 7, 7, 7, 7, 7}));
  }
  const MotorCommands huge = motor_currents(pen, {1e308, -1e308, 0, 0, 0, 0});
  EXPECT_EQ(huge.values[0], 3000);
  EXPECT_EQ(huge.values[1], -3000);
}

/// The weight of parts that are moved by one arm: masses (kg) on the upper arm, on the fore arm and on the links that
/// stay parallel to them, each at its own lever (mm).
TEST(PenMotors, WeightIsThatOfAnyMassesOnTheLinks) {
  constexpr double kG = 9.80665;
  stress::Random random(41);
  for (int round = 0; round < 200; ++round) {
    // Heights: of a part on the upper arm −a cos θ2; on the fore arm −L1 cos θ2 + b sin θ3; on the crank that drives
    // the fore arm c sin θ3, on the rod between −a cos θ2 + c sin θ3.
    const double upper = random.uniform(0, 0.2), fore = random.uniform(0, 0.2), crank = random.uniform(0, 0.1);
    const double a = random.uniform(10, 150), b = random.uniform(10, 180), c = random.uniform(-40, 40);
    const auto energy = [&](double second, double third) {
      return kG * (upper * -a * std::cos(second) + fore * (-150 * std::cos(second) + b * std::sin(third)) +
                   crank * (-a * std::cos(second) + c * std::sin(third)));
    };
    PenGeometry pen = load_pen("riffler");
    pen.channels[0].gravity = kG * (upper * a + fore * 150 + crank * a);
    pen.channels[1].gravity = kG * (fore * b + crank * c);
    const Vec3 angles(0.4, random.uniform(-1, 1), random.uniform(-1, 1));
    const Vec3 hold = gravity_torques(pen, {angles, Vec3(0)})[0];
    constexpr double kStep = 1e-5;
    EXPECT_EQ(hold.x, 0);
    EXPECT_NEAR(hold.y, (energy(angles.y + kStep, angles.z) - energy(angles.y - kStep, angles.z)) / (2 * kStep), 1e-5);
    EXPECT_NEAR(hold.z, (energy(angles.y, angles.z + kStep) - energy(angles.y, angles.z - kStep)) / (2 * kStep), 1e-5);
  }
}

TEST(PenMotors, FrictionIsCompensatedAlongTheMotionAndNotAtRest) {
  const PenGeometry pen = load_pen("riffler");
  for (const double torque : friction_torques(pen, {})) EXPECT_EQ(torque, 0);
  const MotorTorques forward = friction_torques(pen, {Vec3(2), Vec3(-2)});
  EXPECT_NEAR(forward[0], 1.5 + 0.004 * 12, 1e-9) << "motor at 12 rad/s";
  EXPECT_NEAR(forward[2], 1.5 + 0.004 * 17.5, 1e-9);
  EXPECT_EQ(forward[3], -forward[0]);
}

}  // namespace
}  // namespace riffler::pen::motors_test
