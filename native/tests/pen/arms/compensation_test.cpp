// Weight and friction that the motors make up for: within their peaks, behind the gate, and never a source of energy.
#include "riffler/pen/arms/compensation.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pen/arms/pens.hpp"
#include "pen/simulated/simulated_bench.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::compensation_test {
namespace {

using test::SimulatedBench;

int greatest(const SimulatedBench& b) {
  int most = 0;
  for (const std::int16_t c : b.pen->drive().current_ma) most = std::max(most, std::abs(int{c}));
  return b.pen->drive().power ? most : 0;
}

TEST(Compensation, SharesOutsideZeroToOneAreRefusedByName) {
  EXPECT_EQ(test::error_of([] { Compensation{1.5, 0}.validate(); }),
            "gravity must be a number between 0.000000 and 1.000000");
  EXPECT_EQ(test::error_of([] { Compensation{0, -0.1}.validate(); }),
            "friction must be a number between 0.000000 and 1.000000");
}

TEST(Compensation, TheWrenchGetsTheRestOfThePeaksInItsDirection) {
  const PenGeometry pen = load_pen("riffler");
  stress::Random random(7);
  int cut = 0;
  for (int round = 0; round < 2000; ++round) {
    MotorTorques own{}, wanted{};
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      own[k] = random.uniform(-1, 1) * pen.channels[k].peak_torque();
      wanted[k] = random.uniform(-150, 150);
    }
    const MotorCommands told = motor_currents(pen, wanted, own);
    double most = 0;
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      const double torque = 1e-3 * told.values[k] * pen.channels[k].torque_constant;
      EXPECT_NEAR(torque, own[k] + told.scale * wanted[k], 0.05);
      EXPECT_LE(std::abs(torque), pen.channels[k].peak_torque());
      most = std::max(most, std::abs(torque) / pen.channels[k].peak_torque());
    }
    cut += told.scale < 1;
    EXPECT_TRUE(told.scale == 1 || most > 0.999) << "all of what is left";
  }
  EXPECT_GT(cut, 1000);
}

TEST(Compensation, CommandsBeyondThePeaksAreScaledByOneFactor) {
  PenGeometry pen = load_pen("riffler");
  pen.channels[0].gravity = 1e5;
  const JointAngles angles{Vec3(0.1, 0.5, 0.2), Vec3(0.1, 0.5, 0.2)};
  const MotorTorques out = compensation_torques(pen, {1, 0}, angles, {}),
                     weight = motor_torques(pen, gravity_torques(pen, angles));
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    EXPECT_LE(std::abs(out[k]), pen.channels[k].peak_torque() * (1 + 1e-12));
    EXPECT_NEAR(out[k] * weight[0], weight[k] * out[0], 1e-6 * std::abs(weight[0]));
  }
}

TEST(Compensation, OfAnIdentifiedPenIsOnByDefaultAndOmitsUncertainValues) {
  PenGeometry pen = load_pen("riffler");
  EXPECT_EQ(CompensationShares().of(pen).gravity, 0);
  EXPECT_EQ(CompensationShares().of(pen).friction, 0);
  const JointAngles angles{Vec3(0.1, 0.5, 0.2), Vec3(0.1, 0.5, 0.2)}, rates{Vec3(2), Vec3(2)};
  const MotorTorques assumed = compensation_torques(pen, {0, 0.5}, angles, rates);
  pen.uncertainty.emplace();
  EXPECT_EQ(CompensationShares().of(pen).gravity, 1);
  EXPECT_EQ(CompensationShares().of(pen).friction, 0.5);
  EXPECT_EQ(CompensationShares(std::nullopt, 0.2).of(pen).friction, 0.2);
  EXPECT_EQ(CompensationShares(0, std::nullopt).of(pen).gravity, 0);
  for (std::size_t k = 0; k < kPenChannels; ++k) pen.uncertainty->coulomb[k] = 0.1 * pen.channels[k].coulomb;
  const MotorTorques certain = compensation_torques(pen, {0, 0.5}, angles, rates);
  for (std::size_t k = 0; k < kPenChannels; ++k) EXPECT_NEAR(certain[k], 0.804 * assumed[k], 1e-12);
}

/// A hand that lets go after two seconds, and how far the pen has sagged after another.
double sag(double gravity, bool holds = true) {
  const Pose home = SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
  SimulatedPenSettings settings;
  settings.hand.carries = 0;
  SimulatedBench b(settings, [home](double t) { return HandWish{.pose = home, .grip = t < 2 ? 1.0 : 0.0}; }, {},
                   {gravity, 0});
  b.step.holds = holds;
  b.run(3);
  return home.tip.z - b.pen->arms().posture().pose.tip.z;
}

TEST(Compensation, AReleasedPenStaysInPlace) {
  const double none = sag(0), half = sag(0.5);
  EXPECT_GT(none, 20);
  EXPECT_GT(half, 0.5);
  EXPECT_LT(half, none);
  EXPECT_LT(std::abs(sag(1)), 0.3);
  EXPECT_GT(sag(1, false), 20) << "a closed gate bears nothing";
}

TEST(Compensation, GrowsWithTheGateAndEndsWithIt) {
  SimulatedBench b({}, nullptr, {}, {1, 0});
  b.run(0.3);
  const int rising = greatest(b);
  b.run(1.5);
  const int full = greatest(b);
  EXPECT_GT(full, 100);
  EXPECT_LT(rising, full / 2);
  b.step.holds = false;
  b.run(0.01);
  EXPECT_LT(greatest(b), full) << "it falls with the force";
  b.run(0.02);
  EXPECT_EQ(greatest(b), 0);
}

/// What the hand does to move the pen to and fro, N·mm.
double work(double friction) {
  const Pose home = SimulatedPen(SimulatedPenSettings()).arms().posture().pose;
  SimulatedBench b({},
                   [home](double t) {
                     HandWish wish{.pose = home};
                     wish.pose.tip += 15 * std::sin(4 * std::max(0.0, t - 2)) * Vec3(0.6, 0.8, 0);
                     return wish;
                   },
                   {}, {0, friction});
  b.run(2);
  const double before = b.pen->arms().energy().hand;
  b.run(2 * kPi);
  return b.pen->arms().energy().hand - before;
}

TEST(Compensation, TheHandFeelsLessFrictionByTheShare) {
  const double all = work(0), half = work(0.5), most = work(0.8);
  EXPECT_GT(all, 20);
  EXPECT_NEAR(half / all, 0.5, 0.1);
  // Slow motors are made up for by less, so that noise about standstill is not pushed.
  EXPECT_NEAR(most / all, 0.3, 0.1);
}

/// Random hands, loose and firm, that tremble and let go; with jitter on the cable. The motors' account never passes
/// what friction took.
TEST(Compensation, OfFrictionNeverGivesMoreThanFrictionTook) {
  for (unsigned seed = 1; seed <= (test::kSanitized ? 1 : 6); ++seed) {
    SimulatedPenSettings settings;
    settings.cable.jitter_us = 1000;
    const Pose home = SimulatedPen(settings).arms().posture().pose;
    stress::Random random(seed);
    std::array<HandWish, 60> wishes;
    for (HandWish& wish : wishes) {
      wish.pose = home;
      wish.pose.tip += Vec3(random.uniform(-25, 25), random.uniform(-25, 25), random.uniform(-20, 20));
      wish.grip = random.one_in(4) ? 0.05 : random.uniform(0.3, 1);
    }
    SimulatedBench b(
        settings,
        [&](double t) { return wishes[std::min<std::size_t>(static_cast<std::size_t>(t / 0.2), wishes.size() - 1)]; },
        {}, {0, 0.9});
    double most = 0, given = 0;
    b.pen->on_turn = [&] {
      const PenEnergy e = b.pen->arms().energy();
      most = std::max(most, e.motors - e.lost), given = std::max(given, e.motors);
    };
    b.run(12);
    EXPECT_LE(most, 1e-9) << seed;
    EXPECT_GT(given, 10) << seed;
  }
}

TEST(Compensation, TheAppliedWrenchExcludesTheCompensation) {
  SimulatedBench b({}, nullptr, {}, {1, 0.5});
  b.run(2);
  EXPECT_GT(greatest(b), 100);
  EXPECT_LT(glm::length(b.step.last.applied.force), 0.02);
  EXPECT_LT(glm::length(b.step.last.applied.torque), 0.5);
  b.step.law = [](const PenSample&, double, double) { return Wrench{{0.3, 0.2, 0.6}, {}}; };
  b.run(0.5);
  EXPECT_LT(glm::distance(b.step.last.applied.force, Vec3(0.3, 0.2, 0.6)), 0.02);
}

}  // namespace
}  // namespace riffler::pen::compensation_test
