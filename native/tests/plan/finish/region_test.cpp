#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "geom/math.hpp"
#include "plan/finish/region.hpp"

namespace riffler::plan {
namespace {

/// Whether a point lies inside, by the angle that the curve turns around it.
bool winds(const std::vector<std::vector<Vec2>>& curves, const Vec2& p) {
  int inside = 0;
  for (const auto& curve : curves) {
    double turn = 0;
    for (std::size_t k = 0; k < curve.size(); ++k) {
      const Vec2 a = curve[k] - p, b = curve[(k + 1) % curve.size()] - p;
      turn += std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    }
    inside += std::abs(turn) > kPi;
  }
  return inside % 2 == 1;
}

std::vector<Vec2> star(const Vec2& centre, double radius, int corners) {
  std::vector<Vec2> out;
  for (int k = 0; k < corners; ++k) {
    const double r = k % 2 ? radius : 0.4 * radius, t = 2 * kPi * k / corners + 0.1;
    out.emplace_back(centre.x + r * std::cos(t), centre.y + r * std::sin(t));
  }
  return out;
}

TEST(Region, HoldsThePointsThatAnOddNumberOfCurvesGoAround) {
  const std::vector<std::vector<Vec2>> curves{star({0, 0}, 10, 3000), star({1, 0}, 3, 14), star({30, 5}, 4, 8)};
  const Region region(curves);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(-12, 36), y(-12, 12);
  int in = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec2 p(x(random), y(random));
    const bool expected = winds(curves, p);
    in += expected;
    EXPECT_EQ(region.holds(p), expected) << p.x << ' ' << p.y;
  }
  EXPECT_GT(in, 100);
}

TEST(Region, OfNoCurvesIsEmptyAndOneOfALevelLineHoldsNothing) {
  EXPECT_TRUE(Region({}).empty());
  const Region line({{{0, 1}, {5, 1}, {9, 1}}});
  EXPECT_FALSE(line.empty());
  EXPECT_FALSE(line.holds({3, 1}));
}

TEST(Region, FindsPointsWithinADistance) {
  const std::vector<std::vector<Vec2>> curves{star({0, 0}, 10, 60), {{20, -3}, {26, -3}, {26, 4}, {20, 4}}};
  const Region region(curves);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(-14, 30), y(-14, 14), reaches(0, 4);
  int near = 0;
  for (int n = 0; n < 500; ++n) {
    const Vec2 p(x(random), y(random));
    const double reach = reaches(random);
    double least = kInfinity;
    for (const auto& curve : curves)
      for (std::size_t k = 0; k < curve.size(); ++k)
        for (int i = 0; i <= 400; ++i)
          least = std::min(least, glm::length(glm::mix(curve[k], curve[(k + 1) % curve.size()], i / 400.0) - p));
    if (std::abs(least - reach) < 0.03) continue;
    const bool expected = winds(curves, p) || least < reach;
    near += expected;
    ASSERT_EQ(region.within(p, reach), expected) << p.x << ' ' << p.y << ' ' << reach;
  }
  EXPECT_GT(near, 100);
}

}  // namespace
}  // namespace riffler::plan
