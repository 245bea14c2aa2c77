// Volumes in larger boxes against the rays that they had.
#include "riffler/dexel/grown.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "dexel/volumes.hpp"
#include "geom/math.hpp"

namespace riffler::dexel::grown_test {
namespace {

Box3 with_room(const Volume& volume, const Vec3& below, const Vec3& above) {
  const double h = volume.frame().pitch;
  return {volume.frame().box.lower - below * h, volume.frame().box.upper + above * h};
}

TEST(Grown, OldRaysKeepTheirSpansAndNewOnesAreEmpty) {
  for (const char* directions : {"x", "y", "z", "xyz"})
    for (const Vec3 below : {Vec3(0, 0, 0), Vec3(1, 5, 31), Vec3(32, 33, 0), Vec3(64, 32, 96)}) {
      const Volume before = test::random_volume(test::lattice_frame(directions), 5);
      const Volume after = grown(before, with_room(before, below, {3, 0, 40}));
      for (std::size_t g = 0; g < before.grids().size(); ++g) {
        const Grid &was = before.grids()[g], &is = after.grids()[g];
        const Vec3 by = to_local(was.axis(), below);
        const int du = static_cast<int>(by.x), dv = static_cast<int>(by.y);
        std::size_t spans = 0;
        for (int i = 0; i < was.nu(); ++i)
          for (int j = 0; j < was.nv(); ++j) {
            ASSERT_NEAR(is.u(i + du), was.u(i), 1e-12);
            ASSERT_NEAR(is.v(j + dv), was.v(j), 1e-12);
            ASSERT_TRUE(std::ranges::equal(was.ray(i, j), is.ray(i + du, j + dv)));
            ASSERT_TRUE(std::ranges::equal(was.ray_normals(i, j), is.ray_normals(i + du, j + dv)));
            spans += was.ray(i, j).size();
          }
        EXPECT_EQ(is.span_count(), spans);
      }
    }
}

TEST(Grown, WholeTilesChangeHands) {
  const Volume before = test::random_volume(test::lattice_frame("z"), 5);
  const Volume after = grown(before, with_room(before, {64, 32, 1}, {0, 0, 0}));
  const Grid &was = before.grids()[0], &is = after.grids()[0];
  for (int a = 0; a < was.tiles_u(); ++a)
    for (int b = 0; b < was.tiles_v(); ++b) {
      const Tile& tile = was.tile(was.tile_index(a, b));
      if (!tile.spans.empty()) {
        EXPECT_EQ(&tile, &is.tile(is.tile_index(a + 2, b + 1)));
      }
    }
}

TEST(Grown, IsNeverSmallerAndSharesTilesIfNothingChanges) {
  const Volume before = Volume::block({{{0, 0, 0}, {10.3, 10.5, 0.4}}, 1, "xyz"});
  const Volume same = grown(before, {{2, 2, 0.1}, {3, 10.5, 0.2}});
  EXPECT_EQ(same.frame(), before.frame());
  EXPECT_EQ(&same.grids()[0].tile(0), &before.grids()[0].tile(0));
  const Volume taller = grown(before, {{0, 0, -1}, {1, 1, 0.4}});  // 1.4 pitches, and the ray at 0.5 keeps its place
  EXPECT_EQ(taller.frame().box.lower.z, -1);
  EXPECT_EQ(taller.frame().box.upper.z, 1.4);
  EXPECT_EQ(taller.frame().box.upper.x, 10.3);
}

TEST(Grown, RefusesInvalidAndTooLargeBoxes) {
  const Volume block = Volume::block({{{0, 0, 0}, {10, 10, 10}}, 1, "xyz"});
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Box3& wanted : {Box3{{nan, 0, 0}, {1, 1, 1}}, Box3{{0, 0, 0}, {1, kInfinity, 1}}, Box3{},
                             Box3{{0, 5, 0}, {1, 4, 1}}, Box3{{-1e300, 0, 0}, {1, 1, 1}}, Box3{Vec3(-1e9), Vec3(1e9)}})
    EXPECT_THROW(grown(block, wanted), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::dexel::grown_test
