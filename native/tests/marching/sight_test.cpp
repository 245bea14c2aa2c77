#include "marching/sight.hpp"

#include <gtest/gtest.h>

#include "stress/random.hpp"

namespace riffler::marching::sight_test {
namespace {

TEST(Sight, KnowsTheSideOfAnEdgeDespiteRounding) {
  constexpr double e = 0x1p-52;
  const Vec3 a(1 + e, 1, 0), b(1 + 2 * e, 1 + e, 0);  // (1 + e)² − (1 + 2e) = e²
  EXPECT_EQ(twice_area(a, b), e * e);
  EXPECT_EQ(twice_area(b, a), -e * e);
  EXPECT_EQ(twice_area(a, a), 0);
  stress::Random random(6);
  for (int n = 0; n < 100000; ++n) {
    // x (y + dy) − (x + dx) y = x dy − dx y, exact in 64 bits; the products of the doubles round.
    const auto number = [&] { return static_cast<std::int64_t>(random.bits() >> 13) - (std::int64_t{1} << 50); };
    const std::int64_t x = number(), y = number(), dx = random.below(3) - 1, dy = random.below(3) - 1;
    const std::int64_t u = x + dx, v = y + dy, exact = x * dy - dx * y;
    const double area = twice_area(Vec3(static_cast<double>(x), static_cast<double>(y), 0),
                                   Vec3(static_cast<double>(u), static_cast<double>(v), 0));
    ASSERT_EQ((area > 0) - (area < 0), (exact > 0) - (exact < 0)) << x << ", " << y << " and " << u << ", " << v;
  }
}

TEST(Sight, GivesCoordinatesBesideAndAlong) {
  const Sight sight({1, 2, 3}, {0, -5, 0}, 10);
  EXPECT_EQ(sight.direction(), Vec3(0, -1, 0));
  EXPECT_EQ(sight.axis(), 1);
  EXPECT_EQ(sight.sheared({1, -4, 3}), Vec3(0, 0, 6));
  EXPECT_EQ(sight.sheared({1, 4, 3}).z, -2);
  stress::Random random(7);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 origin = 100.0 * random.direction(), direction = random.direction();
    const Sight oblique(origin, direction, 200);
    const double along = random.uniform(-50, 50);
    const Vec3 p = oblique.sheared(origin + along * direction);
    EXPECT_NEAR(p.x, 0, 1e-12);
    EXPECT_NEAR(p.y, 0, 1e-12);
    EXPECT_NEAR(p.z, along, 1e-12);
  }
}

TEST(Sight, IsInABoxThatItTouches) {
  const Vec3 lower(0), upper(1, 2, 3);
  const auto range = [&](const Vec3& origin, const Vec3& direction) {
    return Sight(origin, direction, 3).through(lower, upper);
  };
  const Sight::Range across = range({-1, 1, 1}, {1, 0, 0});
  EXPECT_NEAR(across.enter, 1, 1e-12);
  EXPECT_NEAR(across.leave, 2, 1e-12);
  EXPECT_LE(across.enter, 1);
  EXPECT_GE(across.leave, 2);
  for (const double y : {0.0, 2.0})
    for (const double z : {0.0, 3.0}) {
      EXPECT_FALSE(range({-1, y, z}, {1, 0, 0}).empty()) << "along an edge";
      EXPECT_FALSE(range({-1, y, z}, {1, -0.0, 0}).empty());
      EXPECT_FALSE(range({1, y, z}, {1, 0, 0}).empty()) << "from a corner";
    }
  EXPECT_EQ(range({0.5, 1, 1}, {1, 1, 1}).enter, 0) << "from inside";
  EXPECT_TRUE(range({2, 1, 1}, {1, 0, 0}).empty()) << "behind";
  EXPECT_TRUE(range({-1, 2.001, 1}, {1, 0, 0}).empty());
  EXPECT_TRUE(range({-1, 2.001, 1}, {1, 1e-300, 0}).empty());
}

}  // namespace
}  // namespace riffler::marching::sight_test
