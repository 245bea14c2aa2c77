#include "riffler/dexel/tile.hpp"

#include <gtest/gtest.h>

#include "riffler/dexel/volume.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::dexel::tile_test {
namespace {

/// The first `full` rays hold `spans` each.
std::shared_ptr<Tile> tile_of(int full, int spans) {
  TileBuilder builder(false);
  for (int r = 0; r < full; ++r) {
    for (int k = 0; k < spans; ++k) builder.add({2.0 * k, 2.0 * k + 1});
    builder.next_ray();
  }
  return builder.finish();
}

TEST(Tile, OffsetsOfOneSpanARayAndOfNoneTakeNoMemory) {
  EXPECT_TRUE(tile_of(kTileRays, 1)->offset.one_each());
  EXPECT_EQ(tile_of(kTileRays, 1)->nbytes(), sizeof(Tile) + kTileRays * sizeof(Span));
  EXPECT_EQ(tile_of(0, 1)->nbytes(), sizeof(Tile));
  EXPECT_EQ(tile_of(0, 1)->offset, Tile{}.offset);
  const std::size_t own = (kTileRays + 1) * sizeof(std::uint32_t);
  for (const auto& [full, spans] : {std::pair{kTileRays - 1, 1}, {kTileRays, 2}, {1, 1}}) {
    const auto tile = tile_of(full, spans);
    EXPECT_FALSE(tile->offset.one_each());
    EXPECT_EQ(tile->nbytes(), sizeof(Tile) + own + static_cast<std::size_t>(full) * spans * sizeof(Span));
    for (int r = 0; r < kTileRays; ++r) ASSERT_EQ(tile->ray(r).size(), r < full ? spans : 0) << "ray " << r;
  }
}

TEST(Tile, ACopyKeepsItsOffsetsWhenTheOriginalIsGone) {
  Tile copy;
  {
    const auto original = tile_of(100, 3);
    copy = *original;
  }
  EXPECT_EQ(copy.offset[100], 300U);
  EXPECT_EQ(copy.offset, tile_of(100, 3)->offset);
  EXPECT_FALSE(copy.offset == tile_of(101, 3)->offset);
}

TEST(Tile, RaysThatAreCutButStaySingleTakeSixteenBytes) {
  Volume volume = Volume::block({{{0, 0, 0}, {25.6, 25.6, 10}}, 0.1, "z"});
  sweep::carve(volume, cutters::ball(60, 60), std::vector<Pose>{{{-40, 12, 5}, {0, 0, 1}}, {{70, 12, 5}, {0, 0, 1}}});
  const double rays = 256.0 * 256.0;
  EXPECT_EQ(volume.grids()[0].span_count(), rays);
  EXPECT_LT(static_cast<double>(volume.nbytes()) / rays, 16.3);
}

}  // namespace
}  // namespace riffler::dexel::tile_test
