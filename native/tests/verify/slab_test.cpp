#include "verify/slab.hpp"

#include <gtest/gtest.h>

#include <set>

#include "riffler/dexel/file/file.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::verify::slab_test {
namespace {

Volume block(const char* directions, double pitch = 0.25) {
  return Volume::block({{{-3, 2, -10}, {57, 42, 0}}, pitch, directions});
}

TEST(Slab, EveryTileIsInOneSlab) {
  for (const char* directions : {"z", "x", "xyz"})
    for (const double pitch : {0.25, 0.5, 3.0, 60.0}) {
      const Volume volume = block(directions, pitch);
      std::set<std::pair<std::size_t, std::size_t>> seen;
      for (const Slab& slab : slabs_of(volume))
        for (std::size_t k = 0; k < slab.tile_count(); ++k)
          EXPECT_TRUE(seen.emplace(slab.grid, slab.place(volume.grids()[slab.grid], k)).second);
      std::size_t tiles = 0;
      for (const dexel::Grid& grid : volume.grids()) tiles += grid.tile_count();
      EXPECT_EQ(seen.size(), tiles);
    }
}

TEST(Slab, SlabsCarvedSeparatelyEqualTheWholeCarvedAtOnce) {
  const Tool tool = cutters::fillet(8, 1, 30);
  const Vec3 tilted = glm::normalize(Vec3(0.3, -0.2, 1));
  const std::vector<Pose> poses{
      {{0, 5, -3}, {0, 0, 1}}, {{50, 40, -5}, {0, 0, 1}}, {{20, 10, -2}, tilted}, {{10, 35, -4}, tilted}};
  for (const char* directions : {"z", "xyz"}) {
    const Volume stock = block(directions);
    Volume whole = stock, merged(stock.frame());
    sweep::carve(whole, tool, poses);
    for (const Slab& slab : slabs_of(stock)) {
      Volume part(stock.frame());
      put_tiles(part.grids()[slab.grid], slab, tiles_of(stock.grids()[slab.grid], slab));
      sweep::carve(part, tool, poses);
      put_tiles(merged.grids()[slab.grid], slab, tiles_of(part.grids()[slab.grid], slab));
    }
    merged.touch();
    EXPECT_EQ(to_bytes(merged), to_bytes(whole));
  }
}

TEST(Slab, TheMaterialsBoxCoversEverySpanAndNoMore) {
  for (const char* directions : {"x", "y", "z"}) {
    Volume volume = block(directions);
    for (const Slab& slab : slabs_of(volume)) {
      const dexel::Grid& grid = volume.grids()[slab.grid];
      const Box3 box = material_box(grid, slab, tiles_of(grid, slab));
      ASSERT_FALSE(box.empty());
      EXPECT_TRUE(box.overlaps(volume.frame().box));
      // Along the rays exact, across them up to a tile beyond the block's end.
      const int w = static_cast<int>(grid.axis());
      EXPECT_EQ(box.lower[w], volume.frame().box.lower[w]);
      EXPECT_EQ(box.upper[w], volume.frame().box.upper[w]);
    }
    const Volume nothing(volume.frame());
    const Slab slab = slabs_of(nothing).front();
    EXPECT_TRUE(material_box(nothing.grids()[0], slab, tiles_of(nothing.grids()[0], slab)).empty());
  }
}

}  // namespace
}  // namespace riffler::verify::slab_test
