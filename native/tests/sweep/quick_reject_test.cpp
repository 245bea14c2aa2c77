// Rays out of a step's reach are rejected at a first look; those within it never are.
#include "sweep/quick_reject.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::sweep::quick_reject_test {
namespace {

std::vector<Pose> lifted(std::vector<Pose> poses, double by) {
  for (Pose& pose : poses) pose.tip.z += by;
  return poses;
}

dexel::Stats counted(Volume& volume, const Tool& tool, const std::vector<Pose>& poses) {
  volume.take_stats();
  carve(volume, tool, poses);
  return volume.take_stats();
}

const std::vector<Pose> kRamp{{{8, 9, 6}, {0, 0, 1}}, {{14, 11, 5}, {0, 0, 1}}};

TEST(QuickReject, ABallOverItsOwnCutTestsNoRay) {
  const Tool tool = cutters::ball(6, 30);
  for (const double lift : {1e-6, 0.001, 0.1}) {
    Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 8}}, 0.1, "z"});
    const dexel::Stats first = counted(volume, tool, kRamp), again = counted(volume, tool, lifted(kRamp, lift));
    EXPECT_GT(first.rays_changed, 5000U);
    EXPECT_EQ(again.rays_changed, 0U) << lift;
    EXPECT_EQ(again.rays_tested, 0U) << lift;
  }
}

TEST(QuickReject, ABallBelowItsOwnCutCutsEveryRay) {
  const Tool tool = cutters::ball(6, 30);
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 8}}, 0.1, "z"});
  for (const double depth : {0.0, 1e-6, 2e-6}) {
    const dexel::Stats stats = counted(volume, tool, lifted(kRamp, -depth));
    EXPECT_GT(stats.rays_changed, 5000U) << depth;
  }
}

TEST(QuickReject, MostTestedRaysOfAShortStepAreCut) {
  const Tool tool = cutters::ball(20, 60);
  Volume volume = Volume::block({{{0, 0, 0}, {60, 40, 30}}, 0.1, "z"});
  std::vector<Pose> poses{{{15, 20, 20}, {0, 0, 1}}};
  dexel::Stats stats;
  for (int k = 1; k <= 10; ++k) {
    poses.push_back({{15 + 0.5 * k, 20, 20}, {0, 0, 1}});
    stats = counted(volume, tool, {poses[k - 1], poses[k]});
  }
  EXPECT_GT(stats.rays_changed, 15'000U);
  EXPECT_LT(stats.rays_tested, 1.05 * static_cast<double>(stats.rays_changed));
}

/// A flat end that swings about its tip: lifted a little, it stays off the floor that it cut.
TEST(QuickReject, AFlatEndThatTurnsAboveItsFloorTestsNoRayOfTheFloor) {
  const Tool tool = cutters::flat(6, 30);
  const auto swing = [](double height) {
    return std::vector<Pose>{{{10, 10, height}, glm::normalize(Vec3(0.05, 0, 1))},
                             {{10.5, 10, height}, glm::normalize(Vec3(0.05, 0.08, 1))}};
  };
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 8}}, 0.1, "z"});
  EXPECT_GT(counted(volume, tool, swing(5)).rays_changed, 2500U);
  const dexel::Stats above = counted(volume, tool, swing(5.05));
  EXPECT_LT(above.rays_tested, 600U);  // of about 3000 in its footprint: those at its walls, which lean
  const dexel::Stats below = counted(volume, tool, swing(4.95));
  EXPECT_GT(below.rays_changed, 2500U);
}

/// A ball sunk to its centre in a stroke of a turning hand: its flank meets little of what the ball leaves, along any
/// rays.
TEST(QuickReject, AFlankThatTurnsTestsFewRaysBelowIt) {
  for (const char* directions : {"x", "y", "z"}) {
    Volume volume = Volume::block({{{0, 0, -15}, {60, 40, 0}}, 0.2, directions});
    std::vector<Pose> poses;
    for (int k = 0; k <= 40; ++k) {
      const Vec3 axis = glm::normalize(Vec3(0.25 * std::sin(0.1 * k), 0.1, 1));
      poses.push_back({Vec3(20 + 0.5 * k, 20, 0) - 10.0 * axis, axis});
    }
    const dexel::Stats stats = counted(volume, cutters::ball(20, 60), poses);
    EXPECT_GT(stats.rays_changed, 50'000U) << directions;
    EXPECT_LT(stats.rays_tested, 1.15 * static_cast<double>(stats.rays_changed)) << directions;
  }
}

/// A tool goes along a slot between ribs, without touching them: each ray through it is tested at most once.
TEST(QuickReject, ARayWithManySpansRemembersTheGapThatTheToolIsIn) {
  const double pitch = 0.2;
  Volume volume = Volume::block({{{0, 0, 0}, {60, 20, 10}}, pitch, "x"});
  for (double x = 5; x < 60; x += 10)
    carve(volume, cutters::flat(4, 30), std::vector<Pose>{{{x, -5, 6}, {0, 0, 1}}, {{x, 25, 6}, {0, 0, 1}}});
  std::vector<Pose> poses;
  for (int k = 0; k <= 75; ++k) poses.push_back({{25, -5 + 0.4 * k, 6.1}, {0, 0, 1}});
  const dexel::Stats stats = counted(volume, cutters::flat(3, 30), poses);
  EXPECT_EQ(stats.rays_changed, 0U);
  EXPECT_LE(stats.rays_tested, 20 / pitch * 4 / pitch);
}

/// Both spans of a ray lie on one side of the tool.
TEST(QuickReject, ASlotNextToTheToolCausesNoTestOfARay) {
  for (const double x : {2.0, 58.0}) {
    Volume volume = Volume::block({{{0, 0, 0}, {60, 20, 10}}, 0.2, "x"});
    const std::vector<Pose> step{{{x, -5, 6}, {0, 0, 1}}, {{x, 25, 6}, {0, 0, 1}}};
    carve(volume, cutters::flat(4, 30), step);
    carve(volume, cutters::flat(4, 30), std::vector<Pose>{{{30, -5, 6}, {0, 0, 1}}, {{30, 25, 6}, {0, 0, 1}}});
    const dexel::Stats stats = counted(volume, cutters::flat(3, 30), lifted(step, 0.1));
    EXPECT_EQ(stats.rays_changed, 0U) << x;
    EXPECT_EQ(stats.rays_tested, 0U) << x;
  }
}

}  // namespace
}  // namespace riffler::sweep::quick_reject_test
