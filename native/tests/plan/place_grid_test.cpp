// Distances, paths and contours over a grid of places, compared with brute force and closed forms.
#include "plan/place_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geom/math.hpp"
#include "plan/contours.hpp"

namespace riffler::plan::place_grid_test {
namespace {

const PlaceGrid kGrid{{-3, 5}, 0.25, 61, 47};

TEST(PlaceGrid, DistancesAreThoseOfTheNearestPlace) {
  std::mt19937 random(7);
  for (const int one_in : {1, 5, 200, 100'000}) {
    PlaceSet set(kGrid.size());
    for (char& x : set) x = random() % static_cast<unsigned>(one_in) == 0;
    const Field found = distance_to(kGrid, set);
    for (std::size_t k = 0; k < set.size(); k += 13) {
      double least = kInfinity;
      for (std::size_t i = 0; i < set.size(); ++i)
        if (set[i]) least = std::min(least, glm::length(kGrid.place(i) - kGrid.place(k)));
      if (least < kInfinity)
        ASSERT_NEAR(found[k], least, 1e-9) << one_in << ' ' << k;
      else
        ASSERT_EQ(found[k], kInfinity);
    }
  }
}

TEST(PlaceGrid, PathsRoundACornerHaveTheirLength) {
  PlaceSet in(kGrid.size(), 1), from(kGrid.size(), 0);
  const Vec2 start = kGrid.place(kGrid.index(10, 10)), corner = kGrid.place(kGrid.index(30, 20));
  from[kGrid.index(10, 10)] = 1;
  const Field open = path_lengths(kGrid, in, from);
  for (std::size_t k = 0; k < open.size(); k += 7)
    ASSERT_NEAR(open[k], glm::length(kGrid.place(k) - start), 0.35 + 0.02 * open[k]);
  for (int row = 0; row < 20; ++row) in[kGrid.index(30, row)] = 0;  // a wall up to the corner
  const std::size_t behind = kGrid.index(50, 5);
  const double round = glm::length(corner - start) + glm::length(kGrid.place(behind) - corner);
  EXPECT_NEAR(path_lengths(kGrid, in, from)[behind], round, 0.06 * round);
  for (int row = 0; row < kGrid.rows; ++row) in[kGrid.index(30, row)] = 0;
  EXPECT_EQ(path_lengths(kGrid, in, from)[behind], kInfinity);
}

TEST(PlaceGrid, SliversAreRemovedAndBordersOfThickerRegionsStay) {
  PlaceSet set(kGrid.size(), 0);
  for (int column = 5; column < 55; ++column) set[kGrid.index(column, 5)] = 1;
  for (int column = 5; column < 25; ++column)
    for (int row = 20; row < 40; ++row) set[kGrid.index(column, row)] = 1;
  const PlaceSet found = without_slivers(kGrid, set, 1.0);
  EXPECT_FALSE(found[kGrid.index(30, 5)]);
  for (const auto& [column, row] : {std::pair(5, 20), std::pair(24, 39), std::pair(12, 30)})
    EXPECT_TRUE(found[kGrid.index(column, row)]) << column << ' ' << row;
}

double area_left(const Curve& curve) {
  double twice = 0;
  for (std::size_t k = 0; k < curve.points.size(); ++k) {
    const Vec2 &a = curve.points[k], &b = curve.points[(k + 1) % curve.points.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return 0.5 * twice;
}

TEST(Contours, OfADiscAreACircleWithSmallerValuesOnTheLeft) {
  const Vec2 middle = kGrid.place(kGrid.index(30, 23));
  Field field(kGrid.size());
  for (std::size_t k = 0; k < field.size(); ++k) field[k] = glm::length(kGrid.place(k) - middle);
  const std::vector<Curve> found = contours(kGrid, field, 3.1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].closed);
  EXPECT_NEAR(area_left(found[0]), kPi * 3.1 * 3.1, 0.1);
  for (const Vec2& p : found[0].points) EXPECT_NEAR(glm::length(p - middle), 3.1, 0.01);
  const Curve fewer = simplified(found[0], 0.02);
  EXPECT_LT(fewer.points.size(), found[0].points.size() / 2);
  EXPECT_NEAR(area_left(fewer), kPi * 3.1 * 3.1, 0.8);
}

TEST(Contours, EndAtTheBorderAndAtPlacesThatAreNotFinite) {
  Field field(kGrid.size());
  for (std::size_t k = 0; k < field.size(); ++k) field[k] = kGrid.place(k).x;
  field[kGrid.index(20, 23)] = kInfinity;
  const std::vector<Curve> found = contours(kGrid, field, kGrid.place(20).x - 0.1);
  ASSERT_EQ(found.size(), 2U);
  for (const Curve& curve : found) {
    EXPECT_FALSE(curve.closed);
    EXPECT_GT(curve.points.back().y, curve.points.front().y) << "less lies on the left of a curve that leads up";
  }
}

TEST(Contours, OfTheCellsThatTheyCrossAreTheSame) {
  Field field(kGrid.size());
  for (std::size_t k = 0; k < field.size(); ++k)
    field[k] = std::sin(1.3 * kGrid.place(k).x) + std::cos(0.9 * kGrid.place(k).y);
  std::vector<std::size_t> cells;
  for (int row = 0; row + 1 < kGrid.rows; ++row)
    for (int column = 0; column + 1 < kGrid.columns; ++column) cells.push_back(kGrid.index(column, row));
  std::shuffle(cells.begin(), cells.end(), std::mt19937(3));
  const std::vector<Curve> all = contours(kGrid, field, 0.2), some = contours(kGrid, field, 0.2, {}, cells);
  ASSERT_GT(all.size(), 5U);
  ASSERT_EQ(all.size(), some.size());
  for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k].points, some[k].points);
  EXPECT_TRUE(contours(kGrid, field, 0.2, {}, std::span<const std::size_t>{}).empty());
}

TEST(Contours, OfADiagonalPairOfPlacesNeverCross) {
  const PlaceGrid grid{{0, 0}, 1, 2, 2};
  for (const double middle : {-0.5, 0.5}) {
    const std::vector<Curve> found = contours(grid, {-1, 1 + middle, 1 + middle, -1}, 0);
    ASSERT_EQ(found.size(), 2U);
    for (const Curve& curve : found) EXPECT_EQ(curve.points.size(), 2U);
  }
}

}  // namespace
}  // namespace riffler::plan::place_grid_test
