#include "plan/half_spaces.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"

namespace riffler::plan::half_spaces_test {
namespace {

using Space = HalfSpace<Vec3>;

bool inside(const Vec3& p, const std::vector<Space>& spaces, double reach) {
  for (const Space& s : spaces)
    if (glm::dot(s.along, p) < s.least - 1e-9) return false;
  return std::abs(p.x) <= reach + 1e-9 && std::abs(p.y) <= reach + 1e-9 && std::abs(p.z) <= reach + 1e-9;
}

/// The lowest of all points where three planes meet; infinity where none is inside.
double lowest_by_trying(std::vector<Space> spaces, const Vec3& up, double reach) {
  std::vector<Space> all = spaces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Vec3 along(0);
      along[axis] = side;
      all.push_back({along, -reach});
    }
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      for (std::size_t k = j + 1; k < all.size(); ++k) {
        const Mat3 m = glm::transpose(Mat3(all[i].along, all[j].along, all[k].along));
        if (std::abs(glm::determinant(m)) < 1e-9) continue;
        const Vec3 p = glm::inverse(m) * Vec3(all[i].least, all[j].least, all[k].least);
        if (inside(p, spaces, reach)) best = std::min(best, glm::dot(up, p));
      }
  return best;
}

TEST(HalfSpaces, LowestPointAgreesWithAllCornersTried) {
  stress::Random random(11);
  int empty = 0;
  for (int round = 0; round < 2000; ++round) {
    std::vector<Space> spaces;
    const int n = random.below(9);
    for (int k = 0; k < n; ++k) spaces.push_back({random.direction(), random.uniform(-1.5, 0.7)});
    const Vec3 up = random.direction();
    const double truth = lowest_by_trying(spaces, up, 1);
    const auto found = lowest(std::span<const Space>(spaces), up, 1, 1e-12);
    ASSERT_EQ(found.has_value(), std::isfinite(truth)) << round;
    if (!found) {
      ++empty;
      continue;
    }
    EXPECT_NEAR(glm::dot(up, found->point), truth, 1e-9) << round;
    EXPECT_TRUE(inside(found->point, spaces, 1)) << round;
    for (const int k : found->active) {
      if (k < 0) continue;
      EXPECT_NEAR(glm::dot(spaces[k].along, found->point), spaces[k].least, 1e-9) << round;
    }
  }
  EXPECT_GT(empty, 50);
}

TEST(HalfSpaces, InThePlaneTwoWallsHoldThePoint) {
  const std::vector<HalfSpace<Vec2>> walls{{{0.6, 0.8}, 0.1}, {{0.6, -0.8}, 0.1}, {{1, 0}, -0.5}};
  const auto found = lowest(std::span<const HalfSpace<Vec2>>(walls), {1, 0}, 1, 1e-12);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->point.x, 0.1 / 0.6, 1e-12);
  EXPECT_NEAR(found->point.y, 0, 1e-12);
  EXPECT_EQ(found->active[0] + found->active[1], 1);
}

TEST(HalfSpaces, WallsThatLeaveNoRoomAreDistinguishedFromCoincidentOnes) {
  const std::vector<HalfSpace<Vec2>> shut{{{1, 0}, 0.1}, {{-1, 0}, 0}};
  EXPECT_FALSE(lowest(std::span<const HalfSpace<Vec2>>(shut), {0, 1}, 1, 1e-12));
  const std::vector<HalfSpace<Vec2>> twice{{{1, 0}, 0.1}, {{1, 0}, 0.1}, {{0, 1}, 0.2}};
  const auto found = lowest(std::span<const HalfSpace<Vec2>>(twice), Vec2{1, 1}, 1, 1e-12);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->point.x, 0.1, 1e-12);
  EXPECT_NEAR(found->point.y, 0.2, 1e-12);
}

}  // namespace
}  // namespace riffler::plan::half_spaces_test
