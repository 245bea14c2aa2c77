// Sets of places as bits, entries, and paths through the cleared area, compared with brute force.
#include "plan/rough/layer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "plan/rough/clear_paths.hpp"
#include "plan/rough/entry.hpp"

namespace riffler::plan::layer_test {
namespace {

const PlaceGrid kGrid{{-3, 5}, 0.25, 131, 47};  // rows of three words

TEST(PlaceBits, FindAndTakeWhatIsWithinADisc) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> along(-6, 34), up(2, 20), radii(0, 4);
  PlaceSet set(kGrid.size());
  for (char& x : set) x = random() % 40 == 0;
  PlaceBits bits(kGrid, set);
  for (int n = 0; n < 400; ++n) {
    const Vec2 p(along(random), up(random));
    const double radius = radii(random);
    std::size_t expected = 0;
    for (std::size_t k = 0; k < set.size(); ++k)
      if (set[k] && glm::length(kGrid.place(k) - p) <= radius) ++expected;
    ASSERT_EQ(bits.any_within(p, radius), expected > 0);
    if (n % 4 != 0) continue;
    std::size_t taken = 0;
    bits.take_within(p, radius, [&](const Vec2& off) {
      ++taken;
      const std::size_t k = kGrid.nearest(p + off);
      ASSERT_TRUE(set[k]);
      ASSERT_NEAR(glm::length(kGrid.place(k) - p - off), 0, 1e-12);
      set[k] = 0;
    });
    ASSERT_EQ(taken, expected);
  }
  for (std::size_t k = 0; k < set.size(); ++k) ASSERT_EQ(bits.has(k), set[k] != 0);
}

TEST(Layer, ACutAcrossMaterialIsAsWideAsTheCutterIsInIt) {
  PlaceSet all(kGrid.size(), 0);
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = kGrid.place(k).y > 10;
  Layer layer(kGrid, all, all, 2);
  double most = 0;
  for (double x = 0; x < 20; x += 0.125) most = std::max(most, layer.move({x, 9}, {x + 0.125, 9}));  // 1 mm of material
  EXPECT_NEAR(most, 1, 2 * kGrid.spacing);
  EXPECT_FALSE(layer.touches({10, 9}));
  EXPECT_TRUE(layer.touches({10, 10}));
  EXPECT_TRUE(layer.spares({10, 8}, 0.75));
  EXPECT_FALSE(layer.spares({10, 9.5}, 0.75));
}

double steepest(const std::vector<Vec3>& way) {
  double most = 0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const double length = glm::length(Vec2(way[k]) - Vec2(way[k - 1]));
    EXPECT_GT(length, 0);
    EXPECT_LE(way[k].z, way[k - 1].z);
    most = std::max(most, std::atan2(way[k - 1].z - way[k].z, length));
  }
  return most;
}

TEST(Entry, IsNeverSteeperThanRequested) {
  const Entry helix{{{1, 2}}, 1.5}, ramp{{{0, 0}, {3, 0}, {4, 1}}, 0};
  for (const double slope : {0.005, 0.05, 0.5})
    for (const Entry& entry : {helix, ramp}) {
      const std::vector<Vec3> down = way_down(entry, 4, 1, slope), level = level_way(entry, 1);
      EXPECT_LE(steepest(down), slope * (1 + 1e-9)) << slope << ' ' << entry.radius;
      EXPECT_EQ(down.front().z, 4);
      EXPECT_NEAR(glm::length(down.back() - level.front()), 0, 1e-12);
      EXPECT_EQ(steepest(level), 0);
    }
  EXPECT_EQ(way_down(ramp, 1, 1, 0.05).size(), 1U) << "nothing to go through";
}

TEST(Entry, ARampFollowsASlotRoundItsCorner) {
  PlaceSet in(kGrid.size(), 0);
  for (int column = 10; column <= 30; ++column) in[kGrid.index(column, 20)] = 1;
  for (int row = 20; row <= 40; ++row) in[kGrid.index(30, row)] = 1;
  const std::vector<Vec2> found = ramp_from(kGrid, in, kGrid.index(20, 20), 4);
  EXPECT_NEAR(length_of(found), 4, kGrid.spacing);
  for (const Vec2& p : found) EXPECT_TRUE(in[kGrid.nearest(p)]);
  EXPECT_EQ(ramp_from(kGrid, in, kGrid.index(20, 20), 0.1).size(), 1U);
}

TEST(ClearPaths, GoRoundMaterialOrNotAtAll) {
  const PlaceSet in(kGrid.size(), 1), none(kGrid.size(), 0);
  PlaceSet material(kGrid.size(), 0);
  for (int row = 0; row <= 20; ++row) material[kGrid.index(60, row)] = 1;  // up to (12, 10)
  const Layer layer(kGrid, material, material, 1);
  ClearPaths paths(kGrid, in, none, layer, 1);
  const Vec2 from(8, 7), to(16, 7), above = kGrid.place(kGrid.index(60, 20)) + Vec2(0, 1.5);
  const std::vector<Vec2> way = paths.between(from, to, 40);
  ASSERT_GT(way.size(), 2U);
  EXPECT_EQ(way.front(), from);
  EXPECT_EQ(way.back(), to);
  for (std::size_t k = 1; k < way.size(); ++k)
    for (double s = 0; s <= 1; s += 0.01)
      for (int row = 0; row <= 20; ++row)
        ASSERT_GE(glm::length(glm::mix(way[k - 1], way[k], s) - kGrid.place(kGrid.index(60, row))), 1);
  EXPECT_LT(length_of(way), 1.03 * (glm::length(above - from) + glm::length(to - above)));
  EXPECT_TRUE(paths.between(from, to, 9).empty()) << "too long";
  PlaceSet wall = in;
  for (int row = 0; row < kGrid.rows; ++row) wall[kGrid.index(60, row)] = 0;
  EXPECT_TRUE(ClearPaths(kGrid, wall, none, layer, 1).between(from, to, 100).empty());
}

TEST(ClearPaths, ComeFromWhereNothingStands) {
  const PlaceSet in(kGrid.size(), 1), none(kGrid.size(), 0);
  PlaceSet standing(kGrid.size(), 0);
  for (int column = 0; column < kGrid.columns; ++column) standing[kGrid.index(column, 10)] = 1;
  const Layer layer(kGrid, none, none, 1);
  ClearPaths paths(kGrid, in, standing, layer, 1);
  const Vec2 to(10, kGrid.lower.y + 2.5 + 1.1);
  const std::vector<Vec2> way = paths.from_above(to, 3);
  ASSERT_GE(way.size(), 2U);
  EXPECT_EQ(way.back(), to);
  EXPECT_GT(way.front().y - kGrid.lower.y - 2.5, 1 + kGrid.spacing);
  EXPECT_TRUE(paths.from_above(to, 0.1).empty());
}

}  // namespace
}  // namespace riffler::plan::layer_test
