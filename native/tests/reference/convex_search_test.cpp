#include "reference/convex_search.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace riffler::reference::convex_search_test {
namespace {

/// The largest of parabolas and lines: smooth parts and kinks.
struct Largest {
  std::vector<Tangent> at;    // of its parts
  std::vector<double> bends;  // 0 for a line

  Tangent operator()(double t) const {
    Tangent best{t, -std::numeric_limits<double>::infinity(), 0};
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double d = t - at[k].t, value = at[k].value + d * (at[k].slope + bends[k] * d);
      if (value > best.value) best = {t, value, at[k].slope + 2 * bends[k] * d};
    }
    return best;
  }
};

TEST(ConvexSearch, FindsTheSmallestValueOfRandomFunctions) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  long poses = 0;
  constexpr int kFunctions = 2000;
  for (int k = 0; k < kFunctions; ++k) {
    Largest f;
    for (int part = 0; part < 1 + k % 6; ++part) {
      const double bend = part % 2 ? 0 : std::pow(10, 3 * uniform(random));
      f.at.push_back({0.5 + uniform(random), uniform(random), std::pow(10, 2 * uniform(random)) * uniform(random)});
      f.bends.push_back(bend);
    }
    double low = 0, high = 1;  // thirds: no slopes
    while (high - low > 1e-13) {
      const double third = (high - low) / 3;
      if (f(low + third).value < f(high - third).value)
        high -= third;
      else
        low += third;
    }
    const double expected = std::min({f(low).value, f(0).value, f(1).value});
    const double gap = k % 2 ? 1e-12 : 1e-4;
    const Bracket found = least_of_convex(f, gap, -1e9, 1e9);
    EXPECT_LE(found.upper - found.lower, gap);
    EXPECT_LE(found.lower, expected + 1e-12);
    EXPECT_GE(found.upper, expected - 1e-10);
    EXPECT_LT(found.poses, 60);
    poses += found.poses;
  }
  EXPECT_LT(poses, 12 * kFunctions);
}

TEST(ConvexSearch, EndsWhereRoundingDoes) {
  const auto steep = [](double t) { return Tangent{t, 1e9 * std::abs(t - 0.3), t < 0.3 ? -1e9 : 1e9}; };
  const Bracket found = least_of_convex(steep, 1e-30, -1e9, 1e9);
  EXPECT_LT(found.poses, 300);
  EXPECT_LT(found.upper, 1e-6);
}

TEST(ConvexSearch, StopsBelowAndAbove) {
  const auto bowl = [](double t) { return Tangent{t, (t - 0.4) * (t - 0.4), 2 * (t - 0.4)}; };
  EXPECT_LT(least_of_convex(bowl, 0, -1, 1e-3).poses, 100);
  EXPECT_GT(least_of_convex(bowl, 0, -1, -1e-3).lower, -1e-3);
  EXPECT_EQ(least_of_convex(bowl, 0, 0.2, 1).poses, 2);
}

}  // namespace
}  // namespace riffler::reference::convex_search_test
