#include "riffler/marching/mesher.hpp"

#include <gtest/gtest.h>

#include <array>

#include "riffler/marching/to_mesh.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/float_audit.hpp"
#include "stress/following_run.hpp"
#include "stress/mesh_scenes.hpp"
#include "support/effort.hpp"
#include "tests/marching/followed.hpp"

namespace riffler::marching::mesher_test {
namespace {

using namespace stress;

/// The mesher has what meshing the whole volume gives.
void expect_same(const Mesher& mesher, const Volume& volume, const std::string& what) {
  expect_mesh(mesher, to_mesh(volume), what);
}

TEST(Mesher, FollowsACarvedBlock) {
  for (const char* directions : {"xyz", "z", "x"}) {
    Volume volume = Volume::block({{{0, 0, 0}, {30, 24, 21}}, 0.25, directions});
    Mesher mesher(volume);
    Patches patches(mesher);
    Random random(7);
    for (int stroke = 0; stroke < test::cases(25); ++stroke) {
      carve_at_random(volume, stroke, random);
      const std::vector<std::size_t> changed = mesher.update(volume);
      const std::string what = std::string(directions) + ", stroke " + std::to_string(stroke);
      expect_same(mesher, volume, what);
      patches.update(mesher, changed);
      if (stroke % 5 == 4) patches.expect_same(to_mesh(volume), what);
      EXPECT_LT(changed.size(), 40U) << what;  // of 64 with triangles
      if (HasFatalFailure()) return;
    }
  }
}

/// Sharp edges everywhere, in a bar of many bricks: candidates whose choices depend on each other's across borders.
TEST(Mesher, FollowsABarFullOfEdges) {
  for (unsigned seed = 0; seed < (test::kSanitized ? 1 : 2); ++seed) {
    Random random(100 + seed);
    Volume volume = Volume::block({{{0, 0, 0}, {60, 7, 7}}, 0.25, "xyz"});
    const Tool tools[] = {cutters::flat(1.1, 12), cutters::flat(0.6, 12), cutters::cone_end(0.7, 0.6, 0.2, 2, 12)};
    const auto nick = [&](double x) {
      const Vec3 axis = random.direction();
      const Vec3 at = Vec3(x, 3.5, 3.5) + random.uniform(2, 4.5) * axis;
      sweep::carve(volume, tools[random.below(3)],
                   std::array{Pose{at, axis}, Pose{at + 0.4 * random.direction(), axis}});
    };
    for (int n = 0; n < test::cases(600, 3); ++n) nick(random.uniform(0, 60));
    Mesher mesher(volume);
    EXPECT_TRUE(float_audit(mesher.mesh()).clean()) << float_audit(mesher.mesh());
    for (int step = 0; step < test::cases(16); ++step) {
      nick(8.0 * (1 + random.below(7)) + random.uniform(-1, 1));  // near the borders of bricks
      const std::vector<std::size_t> changed = mesher.update(volume);
      expect_same(mesher, volume, "seed " + std::to_string(seed) + ", nick " + std::to_string(step));
      EXPECT_LT(changed.size(), 10U);
      if (HasFailure()) return;
    }
  }
}

/// Rays that know nothing of each other, in blocks of the grids drawn at random, over several bricks: candidates,
/// entangled folds and vertices that fall back, everywhere.
TEST(Mesher, FollowsGridsThatContradictEachOther) {
  for (unsigned seed = 0; seed < 9; ++seed) {
    if (test::kSanitized && seed % 5 != 3) continue;  // one of each kind of box, far away and not
    Random random(seed);
    const double h = 0.25, offset = seed % 4 == 3 ? 4e5 : 0;
    const Vec3 lower(offset, 0, -offset);
    // Half of them are long: bricks that no change reaches lie on both sides of it.
    const Vec3 size = seed % 2 ? Vec3(random.uniform(6, 20), random.uniform(6, 20), random.uniform(6, 18))
                               : Vec3(random.uniform(40, 50), random.uniform(4, 9), random.uniform(4, 9));
    Volume volume({{lower, lower + size}, h, seed % 3 ? "xyz" : "z"});
    const double share = random.one_in(2) ? random.uniform(0, 0.1) : random.uniform(0, 1);
    const Solid base = turned_box(lower + size / 2.0, size * 0.4, random_turn(random));
    fill(volume, [&](const dexel::Grid& grid, int i, int j) {
      if (random.uniform() >= share) {
        const Vec3 p = to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), 0));
        return meet(base, box(lower, lower + size))(p, to_world(grid.axis(), Vec3(0, 0, 1)));
      }
      return spans_at_random(random, grid, 0.8, true);
    });
    Mesher mesher(volume);
    Patches patches(mesher);
    const std::string what = "seed " + std::to_string(seed);
    EXPECT_TRUE(float_audit(mesher.mesh()).clean()) << what << ": " << float_audit(mesher.mesh());
    for (int step = 0; step < test::cases(8); ++step) {
      const Volume before = volume;
      // One grid's rays in a rectangle become wild, or what they were at first.
      dexel::Grid& grid =
          volume.grids()[static_cast<std::size_t>(random.below(static_cast<int>(volume.grids().size())))];
      const int i0 = random.below(grid.nu()), j0 = random.below(grid.nv());
      const int i1 = std::min(grid.nu() - 1, i0 + random.below(13)),
                j1 = std::min(grid.nv() - 1, j0 + random.below(13));
      change_rays(grid, i0, i1, j0, j1, [&] { return spans_at_random(random, grid, 0.8, true); });
      volume.touch();
      patches.update(mesher, mesher.update(volume));
      expect_same(mesher, volume, what + ", step " + std::to_string(step));
      patches.expect_same(mesher.mesh(), what + ", step " + std::to_string(step));
      if (HasFatalFailure()) return;
    }
  }
}

TEST(Mesher, UpdatesNothingIfNothingHasChanged) {
  Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"});
  Mesher mesher(volume);
  EXPECT_TRUE(mesher.update(volume).empty());
  volume.touch();
  EXPECT_TRUE(mesher.update(volume).empty());
  Volume same = Volume::block(volume.frame());  // other tiles, the same rays
  EXPECT_TRUE(mesher.update(same).empty());
  EXPECT_THROW(mesher.update(Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "z"})), std::invalid_argument);
  EXPECT_TRUE(mesher.patch(0).triangles.size() > 0);
  EXPECT_THROW(mesher.patch(100000), std::out_of_range);
}

TEST(Mesher, FollowsAVolumeThatBecomesEmptyAndBack) {
  const Volume block = Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"});
  Mesher mesher(block);
  const Volume nothing(block.frame());
  EXPECT_EQ(mesher.update(nothing), Mesher(block).patches());
  EXPECT_TRUE(mesher.mesh().empty());
  EXPECT_TRUE(mesher.patches().empty());
  mesher.update(block);
  expect_same(mesher, block, "back");
}

// Its last stroke ends a fold of one brick whose vertices belong to quads of the next, which does not change.
TEST(Mesher, SplitsQuadsOfTheNextBrickAgainWhereAFoldEnds) {
  const stress::FollowedSeries series = stress::follow_series(1, 5, 45, false);
  EXPECT_EQ(series.problem, "");
  EXPECT_EQ(series.strokes, 45);
}

}  // namespace
}  // namespace riffler::marching::mesher_test
