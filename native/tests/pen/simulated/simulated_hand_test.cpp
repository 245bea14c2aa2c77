// The hand on the simulated pen: a spring that yields as one, no stronger than it is, no faster than it is.
#include "pen/simulated/simulated_hand.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pen/arms/pens.hpp"
#include "pen/simulated/simulated_pen.hpp"
#include "support/error_of.hpp"

namespace riffler::pen::simulated_hand_test {
namespace {

PenGeometry frictionless() {
  PenGeometry pen = load_pen("riffler");
  for (PenChannel& c : pen.channels) c.coulomb = 0;
  return pen;
}

/// `seconds` of arms and hand alone, with one more wrench.
struct Held {
  Held(const HandSettings& settings, HandPath path, const PenGeometry& geometry = frictionless())
      : arms(geometry), home(arms.posture().pose), hand(settings, std::move(path), home) {}
  void run(double seconds, const Wrench& extra = {}) {
    constexpr double kStep = 125e-6;
    for (int k = 0; k < std::lround(seconds / kStep); ++k, time += kStep) {
      PenLoad load{.wrench = extra};
      hand.hold(arms, time, kStep, load);
      arms.step(load, kStep);
      fastest = std::max(fastest, glm::length(arms.speed().twist.linear));
    }
  }
  Vec3 way() const { return arms.posture().pose.tip - home.tip; }

  PenDynamics arms;
  Pose home;
  SimulatedHand hand;
  double time = 0, fastest = 0;
};

TEST(SimulatedHand, YieldsByForceOverStiffnessAndNoStrongerThanItIs) {
  const Pose home = Held({}, nullptr).home;
  Held held({.tremor = 0}, hand_at(home));
  held.run(2, {{1, 0, 0}, {}});
  EXPECT_NEAR(held.way().x, 2, 1e-3);
  EXPECT_NEAR(held.way().y, 0, 1e-3);
  EXPECT_NEAR(held.way().z, 0, 1e-3);
  Held loose({.tremor = 0}, hand_at(home, 0.5));  // with half of the weight unborne it sags, too
  loose.run(2, {{1, 0, 0}, {}});
  EXPECT_NEAR(loose.way().x, 4, 0.3);
  Held weak({.strength = {0.5, 400}, .tremor = 0}, hand_at(home));
  weak.run(0.5, {{1, 0, 0}, {}});
  EXPECT_GT(weak.way().x, 20);
}

TEST(SimulatedHand, ThatBearsNoWeightSagsByItAndThatLetsGoDropsThePen) {
  const Pose home = Held({}, nullptr).home;
  Held held({.tremor = 0, .carries = 0}, hand_at(home));
  held.run(2);
  // At home the fore arms lie level and the upper arms hang: all weight is that of joints 3, at 180 mm each.
  EXPECT_NEAR(held.way().z, -(30.0 + 30.0) / 180 / 0.5, 0.05);
  Held dropped({}, hand_at(home, 0));
  dropped.run(0.2);
  EXPECT_LT(dropped.way().z, -20);
}

TEST(SimulatedHand, FollowsAtItsHasteAndTrembles) {
  const Pose home = Held({}, nullptr).home;
  HandWish far{.pose = home};
  far.pose.tip += Vec3(40, 0, 20);
  Held held({.tremor = 0}, [far](double) { return far; });
  held.run(2);
  EXPECT_LT(glm::distance(held.arms.posture().pose.tip, far.pose.tip), 0.05);
  EXPECT_LT(held.fastest, 450);  // it swings over a little
  EXPECT_GT(held.fastest, 250);
  Held trembling({.tremor = 0.5}, hand_at(home));
  double most = 0;
  for (int k = 0; k < 200; ++k) trembling.run(0.01), most = std::max(most, glm::length(trembling.way()));
  EXPECT_GT(most, 0.2);
  EXPECT_LT(most, 1.5);
}

TEST(SimulatedHand, ImpossibleSettingsAreRefusedByName) {
  const auto refused = [](const HandSettings& settings) { return test::error_of([&] { settings.validate(); }); };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({.mass = -1}), "mass must be a number between 0.000000 and 100.000000");
  EXPECT_EQ(refused({.haste = {300, 0}}), "haste.angular must be positive");
  EXPECT_EQ(refused({.carries = 2}), "carries must be a number between 0.000000 and 1.000000");
}

}  // namespace
}  // namespace riffler::pen::simulated_hand_test
