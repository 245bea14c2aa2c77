#include "reference/assembly_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "reference/surface_distance.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"

namespace riffler::reference::assembly_distance_test {
namespace {

/// Ball R3, shank, a taper, a gap, a holder that starts with a chamfer.
Tool assembly() {
  return cutters::ball(6, 12)
      .with_shank({{10, 2.5, 25, 2.5}, {25, 2.5, 32, 6}})
      .with_holder({{34, 14, 38, 20}, {38, 20, 60, 20}, {50, 24, 55, 12}});
}

/// Radius of the union at a height, negative where there is none: straight from the definition.
double radius_at(const Tool& tool, double z) {
  double out = -1;
  if (z >= 0 && z <= 3) out = std::sqrt(std::max(0.0, 9 - (3 - z) * (3 - z)));
  if (z >= 3 && z <= 12) out = 3;
  for (const auto* frusta : {&tool.shank(), &tool.holder()})
    for (const tool::Frustum& f : *frusta)
      if (z >= f.z0 && z <= f.z1) out = std::max(out, f.r0 + (f.r1 - f.r0) * (z - f.z0) / (f.z1 - f.z0));
  return out;
}

TEST(AssemblyDistance, IsThatOfTheUnionInsideAndOutside) {
  const Tool tool = assembly();
  const AssemblyDistance distance(tool);
  stress::Random random(5);
  constexpr double kStep = 1e-3;
  for (int k = 0; k < 400; ++k) {
    const double rho = random.uniform(0, 30), z = random.uniform(-8, 70);
    const bool inside = rho <= radius_at(tool, z);
    EXPECT_EQ(distance.inside(rho, z), inside);
    // At every height: how far it is to where the tool is, or, from inside, to where it is not.
    double best = 1e9;
    for (double at = -10; at < 75; at += kStep) {
      const double r = radius_at(tool, at), across = inside ? std::max(0.0, r - rho) : std::max(0.0, rho - r);
      if (inside || r >= 0) best = std::min(best, std::hypot(z - at, across));
    }
    // Between two heights the radius changes by at most 2.4 steps.
    const double found = std::abs(distance.distance(rho, z));
    EXPECT_LE(found, best + 1e-12) << rho << ", " << z;
    EXPECT_GE(found, best - 3 * kStep) << rho << ", " << z;
    EXPECT_EQ(distance.distance(rho, z) < 0, inside);
  }
}

TEST(AssemblyDistance, AgreesWithKnownDistances) {
  const AssemblyDistance distance(assembly());
  EXPECT_DOUBLE_EQ(distance.distance(0, -2), 2);
  EXPECT_DOUBLE_EQ(distance.distance(0, 2), -2);
  EXPECT_DOUBLE_EQ(distance.distance(2, 3), -1);
  EXPECT_DOUBLE_EQ(distance.distance(1, 6), -2);       // not to the disc between ball and cylinder, which is inside
  EXPECT_DOUBLE_EQ(distance.distance(0.1, 11), -2.6);  // nor to that between cutter and shank
  EXPECT_DOUBLE_EQ(distance.distance(0, 33), 1);       // the gap below the holder
  EXPECT_DOUBLE_EQ(distance.distance(25, 45), 5);
}

TEST(AssemblyDistance, KnowsHollowArcs) {
  // From (4, 0) to (7, 3) about (7, 0): a hollow of radius 3.
  const AssemblyDistance distance(Tool("free", {}, tool::Profile({{{4, 0}, {}}, {{7, 3}, Vec2(7, 0)}, {{7, 10}, {}}})));
  EXPECT_NEAR(distance.distance(6, 1), 3 - std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(distance.distance(4.5, 2.5), -(std::sqrt(2 * 2.5 * 2.5) - 3), 1e-12);
}

TEST(SurfaceDistance, BracketsKnownDistances) {
  // A plane at height 0 and one at −1, and the tool's ball sunk by 0.25 into the upper one, tilted.
  std::vector<Corners> plane;
  for (const double z : {0.0, -1.0}) {
    plane.push_back({Vec3(-40, -40, z), Vec3(50, -40, z), Vec3(50, 45, z)});
    plane.push_back({Vec3(-40, -40, z), Vec3(50, 45, z), Vec3(-40, 45, z)});
  }
  const AssemblyDistance distance(cutters::ball(6, 30));
  const Vec3 axis = glm::normalize(Vec3(0.2, -0.3, 1));
  for (const double height : {-0.25, 0.0, 0.5}) {
    const Pose pose{Vec3(3, 4, 3 + height) - 3.0 * axis, axis};
    const SurfaceBracket found = least_distance(plane, distance, pose, 1e-4);
    EXPECT_LE(found.upper - found.lower, 1.001e-4);
    if (height >= 0) {
      EXPECT_NEAR(found.upper, height, 1e-9);
      EXPECT_LE(found.lower, height);
    }
    const SpreadPoints spread = spread_points(plane, 100'000);
    EXPECT_GE(spread.points.size(), 100'000U);
    const double sampled = least_over(spread.points, distance, pose);
    EXPECT_GE(sampled, found.lower);
    EXPECT_LE(sampled, found.upper + spread.spacing);
  }
}

TEST(SurfaceDistance, FindsTheBottomOfADepth) {
  // A tool upright, wholly through a plane: the deepest point of it is in the middle of the shank.
  const std::vector<Corners> plane{{Vec3(-40, -40, 0), Vec3(90, -40, 0), Vec3(-40, 90, 0)}};
  const SurfaceBracket found =
      least_distance(plane, AssemblyDistance(cutters::ball(6, 30)), {{1.25, 2.5, -10}, {0, 0, 1}}, 1e-4);
  EXPECT_NEAR(found.upper, -3, 1e-9);
  EXPECT_NEAR(found.point.x, 1.25, 1e-6);
  EXPECT_NEAR(found.point.y, 2.5, 1e-6);
}

}  // namespace
}  // namespace riffler::reference::assembly_distance_test
