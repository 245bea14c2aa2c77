// Lists that grow and shrink at random keep what they hold, and ask the system for nothing.
#include "sweep/piece_pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "stress/random.hpp"

namespace riffler::sweep::piece_pool_test {
namespace {

using Lists = std::array<std::vector<double>, dexel::kTileRays>;
using Used = std::array<std::uint32_t, dexel::kTileSide>;

void put(PiecePool& pool, Lists& lists, Used& used, int ray, std::uint32_t n, stress::Random& random) {
  const auto r = static_cast<std::size_t>(ray);
  PiecePool::Place& at = pool.room(ray, n, used.data());
  at.count = n, at.pair = n / 2;
  lists[r].resize(n);
  for (std::uint32_t k = 0; k < n; ++k) pool.pieces(at)[k].span.near = lists[r][k] = random.uniform(0, 1);
  used[r / dexel::kTileSide] |= 1U << (r % dexel::kTileSide);
}

void expect_same(const PiecePool& pool, const Lists& lists, const Used& used) {
  for (std::size_t r = 0; r < lists.size(); ++r) {
    if (!(used[r / dexel::kTileSide] & (1U << (r % dexel::kTileSide)))) continue;
    const PiecePool::Place& at = pool.at(static_cast<int>(r));
    ASSERT_EQ(at.count, lists[r].size());
    ASSERT_EQ(at.pair, at.count / 2);
    ASSERT_LE(at.count, at.room);
    for (std::uint32_t k = 0; k < at.count; ++k) ASSERT_EQ(pool.pieces(at)[k].span.near, lists[r][k]) << r;
  }
}

TEST(PiecePool, KeepsRandomRaysThroughGrowthAndGaps) {
  stress::Random random(7);
  PiecePool pool;
  for (int tile = 0; tile < 3; ++tile) {
    Lists lists;
    Used used{};
    for (int step = 0; step < 30'000; ++step) {
      const int ray = static_cast<int>(random.uniform(0, dexel::kTileRays));
      if (random.one_in(4))
        used[static_cast<std::size_t>(ray) / dexel::kTileSide] &= ~(1U << (ray % dexel::kTileSide));
      else
        put(pool, lists, used, ray, 3 + static_cast<std::uint32_t>(random.uniform(0, random.one_in(9) ? 30 : 4)),
            random);
      if (step % 1000 == 0) expect_same(pool, lists, used);
    }
    put(pool, lists, used, 5, 5000, random);  // more than a block
    expect_same(pool, lists, used);
    pool.clear();
  }
}

/// A tile with sixteen spans in each ray: more than twenty times what is asked for at first.
TEST(PiecePool, GrowsWithinReservedBlocks) {
  stress::Random random(8);
  base::BlockReserve reserve;
  reserve.fill(1 << 15, 128);
  PiecePool pool;
  pool.reserve();
  Lists lists;
  Used used{};
  const std::uint64_t before = base::blocks_from_system();
  for (std::uint32_t n = 3; n <= 16; ++n)
    for (int ray = 0; ray < dexel::kTileRays; ++ray) put(pool, lists, used, ray, n, random);
  EXPECT_EQ(base::blocks_from_system(), before);
  expect_same(pool, lists, used);
}

}  // namespace
}  // namespace riffler::sweep::piece_pool_test
