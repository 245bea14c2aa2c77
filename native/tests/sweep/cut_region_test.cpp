// Adding material and carving next to a mask, judged by the swept solid's distance and by booleans of whole volumes.
#include "sweep/cut_region.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <random>
#include <stdexcept>

#include "dexel/volumes.hpp"
#include "reference/swept_distance.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::sweep::cut_region_test {
namespace {

Vec3 unit(double x, double y, double z) {
  return glm::normalize(Vec3(x, y, z));
}

std::vector<Pose> path() {
  return {{{3, 4, 9}, unit(0, 0, 1)}, {{20, 7, 6}, unit(0, 0, 1)}, {{18, 19, 8}, unit(0.4, -0.2, 1)}};
}

/// Without rotation, where every end is exact and none depends on its neighbours.
std::vector<Pose> straight_path() {
  const Vec3 lean = unit(0.3, -0.2, 1);
  return {{{3, 4, 9}, lean}, {{20, 7, 6}, lean}, {{18, 19, 8}, lean}};
}

bool holds(std::span<const dexel::Span> ray, double s) {
  return std::any_of(ray.begin(), ray.end(), [&](const dexel::Span& x) { return s > x.near && s < x.far; });
}

void expect_no_slivers(const Volume& volume) {
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        double last = -1e300;
        for (const dexel::Span& s : grid.ray(i, j)) {
          ASSERT_LT(s.near, s.far);
          ASSERT_LT(last, s.near);
          ASSERT_GE(s.near, grid.box().lower.z);
          ASSERT_LE(s.far, grid.box().upper.z);
          last = s.far;
        }
      }
}

/// Random points of every ray of lattice volumes: what was there, whether it is protected and where the tool went say
/// what has to be there.
void expect_right(CarveMode mode, const Tool& tool, bool protecting, const char* directions) {
  const dexel::Frame frame = test::lattice_frame(directions);
  const Volume before = test::random_volume(frame, 3), kept = test::random_volume(frame, 4);
  Volume volume = before;
  CarveOptions options;
  options.mode = mode;
  if (protecting) options.protect = &kept;
  const std::vector<Pose> poses = path();
  carve(volume, tool, poses, options);
  expect_no_slivers(volume);
  std::vector<reference::SweptDistance> swept;
  for (std::size_t m = 1; m < poses.size(); ++m) swept.emplace_back(tool.profile(), Motion(poses[m - 1], poses[m]));
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const dexel::Grid& grid = volume.grids()[g];
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const double s = share(random) * test::kCells;
        double off = 1e300;
        for (const auto& motion : swept)
          off = std::min(off, motion.bracket(to_world(grid.axis(), {grid.u(i), grid.v(j), s}), 1e-3, 0.1).upper);
        if (std::abs(off) < 0.011) continue;
        const bool was = holds(before.grids()[g].ray(i, j), s);
        const bool free = off < 0 && !(protecting && holds(kept.grids()[g].ray(i, j), s));
        const bool expected = mode == CarveMode::Add ? was || free : was && !free;
        ASSERT_EQ(holds(grid.ray(i, j), s), expected) << directions << " ray " << i << ", " << j << " at " << s;
      }
  }
}

TEST(CutRegion, HoldsAtEveryPointTheOldTheProtectedAndTheSweptMaterial) {
  for (const Tool& tool : {cutters::ball(7, 30), cutters::flat(6, 30), cutters::fillet(8, 1, 30)})
    for (const char* directions : {"z", "xyz"}) {
      expect_right(CarveMode::Add, tool, false, directions);
      expect_right(CarveMode::Add, tool, true, directions);
      expect_right(CarveMode::Remove, tool, true, directions);
    }
}

TEST(CutRegion, IsTheUnionWithTheCutOfAFullBlock) {
  for (const char* directions : {"z", "x", "xyz"}) {
    const dexel::Frame frame = test::lattice_frame(directions);
    Volume swept = Volume::block(frame), rest = swept;
    carve(rest, cutters::ball(7, 30), straight_path());
    apply(dexel::Boolean::Subtract, swept, rest);
    for (const unsigned seed : {1U, 2U, 5U}) {
      Volume volume = test::random_volume(frame, seed), expected = volume;
      CarveOptions options;
      options.mode = CarveMode::Add;
      carve(volume, cutters::ball(7, 30), straight_path(), options);
      apply(dexel::Boolean::Add, expected, swept);
      for (std::size_t g = 0; g < volume.grids().size(); ++g)
        for (std::size_t t = 0; t < volume.grids()[g].tile_count(); ++t) {
          EXPECT_TRUE(volume.grids()[g].tile(t).offset == expected.grids()[g].tile(t).offset);
          EXPECT_TRUE(volume.grids()[g].tile(t).spans == expected.grids()[g].tile(t).spans);
        }
    }
  }
}

TEST(CutRegion, GivesTheBitsOfCarvingTheUnprotectedVolume) {
  const dexel::Frame frame{
      {{0, 0, 0}, {60, 50, 24}}, 0.3, "xyz"};  // 7 × 6 tiles seen from above, of which the path passes some
  std::vector<Pose> poses = path();
  for (int k = 0; k < 600; ++k)  // more than one batch
    poses.push_back({{20 + 0.03 * k, 20 + 8 * std::sin(0.05 * k), 9}, unit(0.3 * std::sin(0.02 * k), 0.2, 1)});
  Volume stock = Volume::block(frame), mask(frame);
  carve(stock, cutters::flat(10, 30), std::vector<Pose>{{{0, 25, 12}, {0, 0, 1}}, {{60, 25, 12}, {0, 0, 1}}});
  CarveOptions put;
  put.mode = CarveMode::Add;
  carve(mask, cutters::flat(6, 30), std::vector<Pose>{{{28, 0, 5}, {0, 0, 1}}, {{28, 50, 5}, {0, 0, 1}}}, put);
  for (const CarveMode mode : {CarveMode::Add, CarveMode::Remove})
    for (const Volume* protect : {static_cast<const Volume*>(nullptr), static_cast<const Volume*>(&mask)}) {
      if (mode == CarveMode::Remove && !protect) continue;  // cuts the volume itself
      Volume cuttable = mode == CarveMode::Add ? Volume::block(frame) : stock;
      if (mode == CarveMode::Add) apply(dexel::Boolean::Subtract, cuttable, stock);
      if (protect) apply(dexel::Boolean::Subtract, cuttable, *protect);
      Volume cut = cuttable, expected = stock, volume = stock;
      const Cut by_hand = carve(cuttable, cutters::ball(7, 30), poses);
      apply(dexel::Boolean::Subtract, cut, cuttable);
      apply(mode == CarveMode::Add ? dexel::Boolean::Add : dexel::Boolean::Subtract, expected, cut);
      CarveOptions options;
      options.mode = mode, options.protect = protect;
      EXPECT_EQ(carve(volume, cutters::ball(7, 30), poses, options).removed, by_hand.removed);
      EXPECT_FALSE(test::same_rays(volume, stock));
      EXPECT_TRUE(test::same_rays(volume, expected)) << (mode == CarveMode::Add) << (protect != nullptr);
    }
}

TEST(CutRegion, NewWallsFaceOutOfTheMaterial) {
  Volume volume(test::lattice_frame("xyz", 0.4));
  CarveOptions options;
  options.mode = CarveMode::Add;
  const Vec3 centre{12, 11, 10};
  const std::vector<Pose> stay{{centre - Vec3(0, 0, 4), {0, 0, 1}}, {centre - Vec3(0, 0, 4), {0, 0, 1}}};
  carve(volume, cutters::ball(8, 4), stay, options);  // the lower half of a ball
  std::size_t round = 0;
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j) {
        const auto spans = grid.ray(i, j);
        const auto normals = grid.ray_normals(i, j);
        for (std::size_t k = 0; k < spans.size(); ++k)
          for (const auto& [s, n] : {std::pair(spans[k].near, normals[k].near), {spans[k].far, normals[k].far}}) {
            const Vec3 p = to_world(grid.axis(), {grid.u(i), grid.v(j), s}) - centre;
            const Vec3 expected = p.z > -1e-6 ? Vec3(0, 0, 1) : p / 4.0;
            ASSERT_LT(glm::length(n.unpack() - expected), 1e-3);
            round += p.z < -1e-6;
          }
      }
  EXPECT_GT(round, 500U);
}

TEST(CutRegion, ReportsTheVolumeThatEachMoveAddsOrRemoves) {
  for (const char* directions : {"z", "xyz", "y"})
    for (const CarveMode mode : {CarveMode::Add, CarveMode::Remove}) {
      const dexel::Frame frame = test::lattice_frame(directions);
      Volume volume = test::random_volume(frame, 8);
      const Volume kept = test::random_volume(frame, 9);
      const double before = volume.volume();
      CarveOptions options;
      options.mode = mode, options.protect = &kept, options.dt = {0.01, 0.02};
      const Cut cut = carve(volume, cutters::fillet(8, 1, 30), path(), options);
      const double sum = cut.removed[0] + cut.removed[1];
      EXPECT_GT(std::min(cut.removed[0], cut.removed[1]), 10);
      EXPECT_NEAR(sum, std::abs(volume.volume() - before), 1e-9 * before);
      EXPECT_GT(glm::length(cut.force[0]), 0);
    }
}

TEST(CutRegion, ProtectedMaterialStaysBitForBitAndUntouchedTilesStayShared) {
  const dexel::Frame frame{{{0, 0, 0}, {80, 60, 20}}, 0.5, "xyz"};
  const Volume before = Volume::block(frame);
  Volume kept(frame);
  CarveOptions put;
  put.mode = CarveMode::Add;
  const std::vector<Pose> stripe{{{40, 5, 5}, {0, 0, 1}}, {{40, 55, 5}, {0, 0, 1}}};
  carve(kept, cutters::flat(6, 30), stripe, put);
  Volume volume = before, all = before;
  CarveOptions options;
  options.protect = &kept;
  const std::vector<Pose> across{{{30, 30, 12}, {0, 0, 1}}, {{50, 30, 12}, {0, 0, 1}}};
  carve(volume, cutters::ball(6, 30), across, options);
  carve(all, cutters::ball(6, 30), across);
  EXPECT_GT(before.volume() - volume.volume(), 100);
  EXPECT_GT(volume.volume(), all.volume() + 100);
  Volume inside = volume;
  apply(dexel::Boolean::Intersect, inside, kept);
  EXPECT_EQ(inside.volume(), kept.volume());
  std::size_t touched = 0;
  for (std::size_t g = 0; g < 3; ++g)
    for (std::size_t t = 0; t < before.grids()[g].tile_count(); ++t)
      touched += volume.grids()[g].shared_tile(t) != before.grids()[g].shared_tile(t);
  EXPECT_LE(touched, 16U);  // of 64: those that the tool's footprint meets
}

TEST(CutRegion, SharesAllTilesIfNothingChanges) {
  const dexel::Frame frame{{{0, 0, 0}, {40, 40, 12}}, 0.5, "xyz"};
  Volume full = Volume::block(frame), empty(frame);
  const Volume all = full;
  const auto was = std::pair(full.revision(), empty.revision());
  CarveOptions add, spare;
  add.mode = CarveMode::Add, spare.protect = &all;
  carve(full, cutters::ball(6, 30), path(), add);
  EXPECT_EQ(full.take_stats().tiles_changed, 0U);
  carve(full, cutters::ball(6, 30), path(), spare);
  add.protect = &all;
  carve(empty, cutters::ball(6, 30), path(), add);
  EXPECT_EQ(std::pair(full.revision(), empty.revision()), was);
  EXPECT_TRUE(test::same_rays(full, all));
}

TEST(CutRegion, AddingAndRemovingTheSameLeavesTheRest) {
  Volume volume = Volume::block({{{0, 0, 0}, {24, 24, 24}}, 0.5, "xyz"});
  CarveOptions add;
  add.mode = CarveMode::Add;
  const std::vector<Pose> outside{{{-30, 5, 5}, {0, 0, 1}}, {{-30, 9, 5}, {0, 0, 1}}};
  carve(volume, cutters::ball(6, 30), outside, add);
  EXPECT_EQ(volume.volume(), 24.0 * 24 * 24);
  carve(volume, cutters::ball(6, 30), straight_path());
  const Volume cut = volume;
  carve(volume, cutters::ball(6, 30), straight_path(), add);
  EXPECT_NEAR(volume.volume(), 24.0 * 24 * 24, 1e-9);
  carve(volume, cutters::ball(6, 30), straight_path());
  EXPECT_NEAR(volume.volume(), cut.volume(), 1e-6);
}

TEST(CutRegion, GivesTheSameBytesForAnyNumberOfThreadsFarFromTheOrigin) {
  const Vec3 far{1e5, -1e5, 1e5};
  const dexel::Frame frame{{far, far + Vec3(60, 50, 24)}, 0.3, "xyz"};
  std::vector<Pose> poses = path();
  for (Pose& p : poses) p.tip += far;
  std::vector<Volume> volumes;
  for (const char* threads : {"1", "2", "4"}) {
    setenv("RIFFLER_THREADS", threads, 1);
    Volume volume(frame), kept = Volume::block(frame);
    carve(kept, cutters::flat(10, 30), poses);
    CarveOptions options;
    options.mode = CarveMode::Add, options.protect = &kept;
    carve(volume, cutters::ball(12, 30), poses, options);
    EXPECT_GT(volume.volume(), 1);
    volumes.push_back(std::move(volume));
  }
  unsetenv("RIFFLER_THREADS");
  EXPECT_TRUE(test::same_rays(volumes[0], volumes[1]));
  EXPECT_TRUE(test::same_rays(volumes[0], volumes[2]));
}

TEST(CutRegion, NamesAnotherGridAndChangesNothingWhenCancelled) {
  const dexel::Frame frame = test::lattice_frame("xyz");
  Volume volume = test::random_volume(frame, 1);
  const Volume before = volume, coarse = Volume::block(test::lattice_frame("xyz", 1));
  CarveOptions options;
  options.mode = CarveMode::Add, options.protect = &coarse;
  try {
    carve(volume, cutters::ball(7, 30), path(), options);
    ADD_FAILURE();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "protect must have the same grid as the volume, but its pitch differs");
  }
  options.protect = nullptr, options.progress = [](double) { return false; };
  EXPECT_THROW(carve(volume, cutters::ball(7, 30), path(), options), Cancelled);
  EXPECT_TRUE(test::same_rays(volume, before));
  EXPECT_EQ(volume.revision(), before.revision());
}

}  // namespace
}  // namespace riffler::sweep::cut_region_test
