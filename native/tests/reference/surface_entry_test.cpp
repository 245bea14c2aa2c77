#include "reference/surface_entry.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/surface_distance.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"

namespace riffler::reference::surface_entry_test {
namespace {

Tool assembly() {
  return cutters::ball(6, 12)
      .with_shank({{10, 2.5, 25, 2.5}, {25, 2.5, 32, 6}})
      .with_holder({{34, 14, 38, 20}, {38, 20, 60, 20}, {50, 24, 55, 12}});
}

std::vector<Corners> random_triangles(stress::Random& random, int count) {
  std::vector<Corners> out;
  for (int k = 0; k < count; ++k) {
    const Vec3 at{random.uniform(-15, 15), random.uniform(-15, 15), random.uniform(-15, 15)};
    const double size = random.power_of_ten(-1, 1.3);
    out.push_back({at, at + size * random.direction(), at + size * random.direction()});
  }
  return out;
}

TEST(SurfaceEntry, IsTheNegativeOfTheLeastDistance) {
  const AssemblyDistance tool(assembly());
  stress::Random random(7);
  constexpr double kGap = 1e-3;
  int entered = 0;
  for (int k = 0; k < 40; ++k) {
    const std::vector<Corners> triangles = random_triangles(random, 30);
    const Pose pose{{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)}, random.direction()};
    const Entry entry = entries(triangles, tool, std::vector{pose}, kGap)[0];
    const SurfaceBracket other = least_distance(triangles, tool, pose, kGap);
    EXPECT_GE(entry.bound, -other.upper) << k;
    EXPECT_LE(entry.attained, std::max(0.0, -other.lower)) << k;
    EXPECT_LE(entry.bound, entry.attained + kGap);
    entered += entry.attained > 0;
    if (entry.attained > 0) {
      EXPECT_DOUBLE_EQ(-tool(entry.point, pose), entry.attained);
    }
  }
  EXPECT_GT(entered, 20);
}

TEST(SurfaceEntry, IsFoundToTheGapAlongAWallThatIsTouchedByCutterAndShank) {
  const AssemblyDistance tool(cutters::ball(6, 12).with_shank({{12, 3, 40, 3}}));
  const std::vector<Corners> wall{{Vec3{3, -50, -50}, {3, 50, -50}, {3, 0, 90}}};
  // Near seams of its pieces tangents do not tell; there it takes the more cuts.
  for (const double deep : {0.0, 1e-3, 0.3}) {
    const Entry entry = entries(wall, tool, std::vector{Pose{{deep, 0, 0}, {0, 0, 1}}}, 1e-3, 20'000)[0];
    EXPECT_LE(entry.attained, deep + 1e-12);
    EXPECT_GE(entry.bound, deep);
    EXPECT_LE(entry.bound, deep + 1e-3 + 1e-12) << deep;
  }
}

TEST(SurfaceEntry, NoPointOfATriangleIsDeeperThanTheTangentBound) {
  const AssemblyDistance tools[] = {AssemblyDistance(assembly()), AssemblyDistance(cutters::fillet(12, 2, 20)),
                                    AssemblyDistance(cutters::cone_end(1.0, 1, 0.4, 8, 40))};
  stress::Random random(8);
  int told = 0;
  for (int k = 0; k < 30'000; ++k) {
    const AssemblyDistance& tool = random.one_of(tools);
    const Pose pose{{0, 0, 0}, random.direction()};
    const Vec3 across = random.square_to(pose.axis);
    const Vec3 p = random.uniform(0, 16) * across + random.uniform(-1, 45) * pose.axis;
    const double size = random.power_of_ten(-3, 0.5);
    const Corners t{p + size * random.direction(), p + size * random.direction(), p + size * random.direction()};
    const Vec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const double radius =
        std::max({glm::length(t[0] - middle), glm::length(t[1] - middle), glm::length(t[2] - middle)});
    const std::optional<double> bound = tool.tangent_bound(t, middle, radius, pose);
    if (!bound) continue;
    ++told;
    for (int n = 0; n < 12; ++n) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      EXPECT_GE(tool(t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), pose), -*bound - 1e-12);
    }
  }
  EXPECT_GT(told, 5'000);
}

}  // namespace
}  // namespace riffler::reference::surface_entry_test
