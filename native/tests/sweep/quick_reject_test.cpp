// Rays out of a step's reach are rejected at a first look; those within it never are.
#include "sweep/quick_reject.hpp"

#include <gtest/gtest.h>

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

TEST(QuickReject, ABallBelowItsOwnCutTakesFromEveryRay) {
  const Tool tool = cutters::ball(6, 30);
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 8}}, 0.1, "z"});
  for (const double depth : {0.0, 1e-6, 2e-6}) {
    const dexel::Stats stats = counted(volume, tool, lifted(kRamp, -depth));
    EXPECT_GT(stats.rays_changed, 5000U) << depth;
  }
}

TEST(QuickReject, OfAShortStepMostRaysThatAreTestedAreCut) {
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
TEST(QuickReject, AFlatEndThatTurnsAboveItsFloorTestsNoRayOfThat) {
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

}  // namespace
}  // namespace riffler::sweep::quick_reject_test
