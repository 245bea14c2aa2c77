// The arms' motion against closed forms and balances, the grip's mass against the kinematics.
#include "pen/simulated/simulated_dynamics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "stress/matrix.hpp"
#include "support/pens.hpp"

namespace riffler::pen::simulated_dynamics_test {
namespace {

PenGeometry without_friction() {
  PenGeometry pen = load_pen("riffler");
  for (PenChannel& c : pen.channels) c.coulomb = c.viscous = 0;
  return pen;
}

PenGeometry weightless() {
  PenGeometry pen = without_friction();
  for (PenChannel& c : pen.channels) c.gravity = 0;
  return pen;
}

double balance(const PenEnergy& e) {
  return e.kinetic + e.potential - e.motors - e.hand - e.borne + e.lost;
}

/// Two directions square to the axis.
std::array<Vec3, 2> sides(const Vec3& axis) {
  const Vec3 first = glm::normalize(glm::cross(axis, Vec3(0.3, 0.9, 0.2)));
  return {first, glm::cross(axis, first)};
}

/// Mass of the grip's five coordinates (three of its point, two turns square to its axis), from what the inverse
/// kinematics say that the joints do: N·s²/mm and so on.
stress::Matrix mass_at(const PenGeometry& geometry, const Pose& pose) {
  const PenKinematics pen(geometry);
  const auto [u, v] = sides(pose.axis);
  constexpr double kStep = 1e-4;
  std::array<std::array<double, 6>, 5> rates{};
  for (std::size_t k = 0; k < 5; ++k) {
    const auto at = [&](double step) {
      Pose p = pose;
      if (k < 3) p.tip[static_cast<int>(k)] += step;
      if (k >= 3) p.axis = glm::normalize(p.axis + step * glm::cross(k == 3 ? u : v, p.axis));
      return pen.inverse(p).angles;
    };
    const JointAngles ahead = at(kStep), behind = at(-kStep);
    for (std::size_t j = 0; j < 6; ++j) {
      const int i = static_cast<int>(j % 3);
      rates[k][j] = (ahead[j / 3][i] - behind[j / 3][i]) / (2 * kStep);
    }
  }
  stress::Matrix mass(5, 5);
  for (int a = 0; a < 5; ++a)
    for (int b = 0; b < 5; ++b) {
      if (a == b) mass(a, b) = 1e-3 * (a < 3 ? geometry.grip_mass : geometry.grip_inertia);
      for (const PenChannel& c : geometry.channels) {
        const std::size_t j = 3 * index(c.arm) + static_cast<std::size_t>(c.joint);
        mass(a, b) += 1e-3 * c.inertia * rates[static_cast<std::size_t>(a)][j] * rates[static_cast<std::size_t>(b)][j];
      }
    }
  return mass;
}

TEST(SimulatedDynamics, AWrenchAcceleratesTheGripByTheMassThatTheKinematicsGiveIt) {
  stress::Random random(81);
  for (int round = 0; round < 40; ++round) {
    PenGeometry geometry = round % 2 ? test::turned_pen() : load_pen("riffler");
    for (PenChannel& c : geometry.channels) c.coulomb = c.viscous = c.gravity = 0;
    PenDynamics pen(geometry);
    while (!pen.place(test::random_pose(random, geometry))) continue;
    const Pose pose = pen.posture().pose;
    const auto [u, v] = sides(pose.axis);
    const Wrench push{random.direction(), 30.0 * (random.uniform(-1, 1) * u + random.uniform(-1, 1) * v)};
    const std::vector<double> expected = stress::inverse(mass_at(geometry, pose)) *
                                         std::vector<double>{push.force.x, push.force.y, push.force.z,
                                                             glm::dot(push.torque, u), glm::dot(push.torque, v)};
    constexpr double kTime = 1e-6;
    pen.step({.wrench = push}, kTime);
    const Twist twist = pen.speed().twist;
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(twist.linear[static_cast<int>(k)] / kTime, expected[k], 1e-5 * std::abs(expected[k]) + 1e-2);
    EXPECT_NEAR(glm::dot(twist.angular, u) / kTime, expected[3], 1e-5 * std::abs(expected[3]) + 1e-2);
    EXPECT_NEAR(glm::dot(twist.angular, v) / kTime, expected[4], 1e-5 * std::abs(expected[4]) + 1e-2);
  }
}

/// Swings on a spring for a second, without friction: the largest error of the balance.
double worst_balance(double step) {
  const PenGeometry geometry = without_friction();
  PenDynamics pen(geometry);
  const Pose home = pen.posture().pose;
  const double start = balance(pen.energy());
  double worst = 0;
  for (int k = 0; k < std::lround(0.5 / step); ++k) {
    pen.step({}, step);
    worst = std::max(worst, std::abs(balance(pen.energy()) - start));
  }
  EXPECT_GT(glm::distance(home.tip, pen.posture().pose.tip), 1);
  EXPECT_GT(pen.energy().kinetic, 1);
  return worst;
}

TEST(SimulatedDynamics, EnergyOfAFallingPenIsKeptToSecondOrderOfTheStep) {
  const double coarse = worst_balance(1e-3), middle = worst_balance(5e-4), fine = worst_balance(2.5e-4);
  EXPECT_NEAR(coarse / middle, 4, 1.5);
  EXPECT_NEAR(middle / fine, 4, 1.5);
  EXPECT_LT(worst_balance(1.25e-4), 0.05);  // N·mm, of some hundred that come and go
}

TEST(SimulatedDynamics, EnergyOfHandAndMotorsIsStoredOrDissipated) {
  PenDynamics pen(load_pen("riffler"));
  const double start = balance(pen.energy());
  double worst = 0;
  for (int k = 0; k < 16000; ++k) {
    const double t = 125e-6 * k;
    PenLoad load;
    load.motors = {3 * std::sin(7 * t), 2 * std::sin(11 * t), 4 * std::sin(5 * t), -2 * std::sin(9 * t), 3, -1};
    load.wrench.force = {std::sin(13 * t), std::cos(17 * t), 1.2};
    load.damping = {2e-3, 5};
    load.drift.linear = {20 * std::sin(3 * t), 0, 0};
    load.mass = k < 8000 ? 0.05 : 0.0, load.inertia = 10;
    load.brake = k % 4000 > 3500;
    load.borne = 0.5;
    const double lost = pen.energy().lost;
    pen.step(load, 125e-6);
    EXPECT_GE(pen.energy().lost, lost - 1e-6);
    worst = std::max(worst, std::abs(balance(pen.energy()) - start));
    EXPECT_NEAR(pen.posture().length, 30, 1e-9);
  }
  EXPECT_GT(pen.energy().lost, 50);
  EXPECT_LT(worst, 0.05);
}

TEST(SimulatedDynamics, MotorsThatBearTheWeightHoldThePenStill) {
  const PenGeometry geometry = without_friction();
  PenDynamics pen(geometry);
  const Vec3 start = pen.posture().pose.tip;
  for (int k = 0; k < 8000; ++k) {
    const MotorTorques bear = motor_torques(geometry, gravity_torques(geometry, pen.posture().angles));
    pen.step({.motors = bear}, 125e-6);
  }
  EXPECT_LT(glm::distance(pen.posture().pose.tip, start), 1e-6);
  PenDynamics falls(geometry);
  for (int k = 0; k < 800; ++k) falls.step({}, 125e-6);
  EXPECT_LT(falls.posture().pose.tip.z, start.z - 10);
}

TEST(SimulatedDynamics, DryFrictionHoldsWhatIsWeakerThanItselfForGood) {
  const PenGeometry geometry = load_pen("riffler");
  PenDynamics pen(geometry);
  const JointAngles start = pen.posture().angles;
  const MotorTorques weight = motor_torques(geometry, gravity_torques(geometry, start));
  PenLoad load{.motors = weight};
  for (std::size_t k = 0; k < kPenChannels; ++k) load.motors[k] += k % 2 ? 1.4 : -1.4;
  for (int k = 0; k < 8000; ++k) pen.step(load, 125e-6);
  for (std::size_t arm = 0; arm < 2; ++arm) EXPECT_LT(glm::length(pen.posture().angles[arm] - start[arm]), 1e-9) << arm;
  load.motors[1] += 30;
  for (int k = 0; k < 800; ++k) pen.step(load, 125e-6);
  EXPECT_GT(glm::length(pen.posture().angles[0] - start[0]), 1e-3);
}

/// m ẍ + b ẋ + k x = k from rest. Mass enough to make the arms' of no account, and all along one line.
TEST(SimulatedDynamics, AHeavyGripOnASpringFollowsTheClosedForm) {
  const PenGeometry geometry = weightless();
  PenDynamics pen(geometry);
  const Vec3 home = pen.posture().pose.tip;
  const Vec3 axis = pen.posture().pose.axis;
  constexpr double kMass = 1e3, kStiffness = 100, kDamping = 2, kWay = 1e-2;  // kg, N/mm, N·s/mm, mm
  const double rate = kDamping / (2 * kMass * 1e-3), beat = std::sqrt(kStiffness / (kMass * 1e-3) - rate * rate);
  double worst = 0;
  for (int k = 0; k < 4000; ++k) {
    PenLoad load;
    load.mass = kMass, load.inertia = 1e7;
    load.damping = {kDamping, 0};
    load.stiffness = {kStiffness, 0}, load.strength = {100, 0}, load.aim = {home + kWay * axis, axis};
    pen.step(load, 250e-6);
    const double t = 250e-6 * (k + 1);
    const double expected = kWay * (1 - std::exp(-rate * t) * (std::cos(beat * t) + rate / beat * std::sin(beat * t)));
    worst = std::max(worst, std::abs(glm::dot(pen.posture().pose.tip - home, axis) - expected));
  }
  EXPECT_LT(worst, 2e-3 * kWay);
}

TEST(SimulatedDynamics, AnUnreachableGripIsRefusedAndStopsEndTheMotion) {
  PenGeometry geometry = load_pen("riffler");
  geometry.grip_length = 500;
  EXPECT_THROW(PenDynamics{geometry}, std::invalid_argument);
  geometry = load_pen("riffler");
  PenDynamics pen(geometry);
  EXPECT_FALSE(pen.place({Vec3(1000, 0, 0), Vec3(0, 0, 1)}));
  for (int k = 0; k < 32000; ++k) pen.step({.wrench = {{10, 3, 4}, {0, 0, 0}}}, 125e-6);
  for (const PenChannel& c : geometry.channels) {
    const double angle = pen.posture().angles[index(c.arm)][c.joint];
    EXPECT_GT(angle, c.low - 0.1);
    EXPECT_LT(angle, c.high + 0.1);
  }
  EXPECT_LT(glm::length(pen.speed().twist.linear), 5);
}

}  // namespace
}  // namespace riffler::pen::simulated_dynamics_test
