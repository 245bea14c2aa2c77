// Tiles from the thread that cuts to the one that shows.
#include "riffler/session/tile_exchange.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "dexel/volumes.hpp"
#include "riffler/base/ring.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::session::tile_exchange_test {
namespace {

Volume block(const char* directions = "xyz") {
  return Volume::block({{{0, 0, 0}, {60, 60, 20}}, 1, directions});
}

TEST(TileExchange, PassesNothingOnBeforeARequest) {
  Volume cut = block(), shown = cut;
  TileExchange exchange(cut);
  std::vector<TileExchange::Place> places;
  TileExchange::Mark mark;
  exchange.serve(cut, {});
  EXPECT_FALSE(exchange.take(shown, places, mark));
  exchange.ask();
  EXPECT_FALSE(exchange.take(shown, places, mark));
  exchange.serve(cut, {3, true});
  EXPECT_TRUE(exchange.take(shown, places, mark));
  EXPECT_TRUE(places.empty());
  EXPECT_EQ(mark.strokes, 3U);
  EXPECT_TRUE(mark.in_stroke);
  EXPECT_EQ(shown.revision(), cut.revision());
  EXPECT_FALSE(exchange.take(shown, places, mark));
}

TEST(TileExchange, GathersUntilARequestAndGivesEachTileOnce) {
  Volume cut = block(), shown = cut;
  TileExchange exchange(cut);
  sweep::MoveCarver carver(cut, cutters::ball(10, 30), {});
  for (int k = 0; k < 100; ++k) {
    carver.move({{30 + 0.1 * k, 30, 15}, {0, 0, 1}}, {{30.1 + 0.1 * k, 30, 15}, {0, 0, 1}}, 1e-3);
    exchange.changed(carver.replaced());
  }
  std::vector<TileExchange::Place> places;
  TileExchange::Mark mark;
  exchange.ask();
  exchange.serve(cut, {});
  ASSERT_TRUE(exchange.take(shown, places, mark));
  EXPECT_TRUE(test::same_spans(shown, cut));
  EXPECT_NE(shown.revision(), cut.revision());
  std::size_t changed = 0;
  const Volume before = block();
  for (const TileExchange::Place& p : places)
    changed += shown.grids()[p.grid].tile(p.tile).spans != before.grids()[p.grid].tile(p.tile).spans;
  EXPECT_EQ(changed, places.size());
  EXPECT_GT(places.size(), 3U);
}

/// What is shown is always a state between two cuts: a cut lowers a whole block of rays, over several tiles and grids.
TEST(TileExchange, TwoThreadsNeverSeeHalfOfACut) {
  Volume cut = block("z"), shown = cut;
  TileExchange exchange(cut);
  constexpr int kCuts = 400;
  std::atomic<bool> ended{false};
  std::thread cutter([&] {
    sweep::MoveCarver carver(cut, cutters::flat(40, 30), {});
    for (int k = 0; k < kCuts; ++k) {
      const Pose from{{30, 30, 20 - 0.02 * k}, {0, 0, 1}}, to{{30, 30, 20 - 0.02 * (k + 1)}, {0, 0, 1}};
      carver.move(from, to, 1e-3);
      exchange.changed(carver.replaced());
      exchange.serve(cut, {static_cast<std::uint64_t>(k) + 1, true});
    }
    ended = true;
  });
  int looks = 0, halves = 0;
  std::vector<TileExchange::Place> places;
  TileExchange::Mark mark;
  for (bool last = false; !last;) {
    last = ended;
    exchange.ask();
    std::this_thread::yield();
    if (last) exchange.serve(cut, {kCuts, false});
    if (!exchange.take(shown, places, mark)) continue;
    ++looks;
    const double depth = 20 - 0.02 * static_cast<double>(mark.strokes);
    for (const int at : {20, 30, 40}) halves += std::abs(shown.grids()[0].ray(at, at)[0].far - depth) > 1e-9;
  }
  cutter.join();
  EXPECT_GT(looks, 0);
  EXPECT_EQ(halves, 0);
  EXPECT_TRUE(test::same_spans(shown, cut));
}

TEST(Ring, KeepsOrderRefusesEntriesWithoutRoomAndWraps) {
  base::Ring<int> ring(3);
  int value = 0;
  EXPECT_FALSE(ring.take(value));
  for (int round = 0; round < 5; ++round) {
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(ring.put(10 * round + k));
    EXPECT_FALSE(ring.put(99));
    EXPECT_EQ(ring.size(), 3U);
    for (int k = 0; k < 3; ++k) {
      EXPECT_TRUE(ring.take(value));
      EXPECT_EQ(value, 10 * round + k);
    }
    EXPECT_FALSE(ring.take(value));
  }
  EXPECT_THROW(base::Ring<int>(0), std::invalid_argument);
}

TEST(Ring, TwoThreadsLoseNothing) {
  base::Ring<long> ring(64);
  constexpr long kMany = 200'000;
  std::thread other([&] {
    for (long k = 0; k < kMany;)
      if (ring.put(k)) ++k;
  });
  long next = 0, wrong = 0;
  for (long value = 0; next < kMany;)
    if (ring.take(value)) wrong += value != next++;
  other.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace riffler::session::tile_exchange_test
