#include "riffler/plan/drop.hpp"

#include <gtest/gtest.h>

#include "cutters.hpp"
#include "mesh/shapes.hpp"
#include "reference/cutter_distance.hpp"
#include "stress/random.hpp"

namespace riffler::plan::drop_test {
namespace {

Mesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  Mesh m;
  m.vertices = {a, b, c}, m.triangles = {{0, 1, 2}};
  return m;
}

TEST(Drop, OnAFlatLandsOnIt) {
  const Mesh plate = mesh::box_mesh({-10, -10, 0}, {10, 10, 4});
  for (const Tool& tool : named_cutters()) {
    const DropCutter drop(plate, tool);
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(3, -2, 100), Vec3(10, 10, 0)}) {
      EXPECT_TRUE(drop(p).touches);
      EXPECT_NEAR(drop(p).height, 4, 1e-12) << tool.name();
    }
    EXPECT_FALSE(drop(Vec3(30, 0, 0)).touches);
  }
}

TEST(Drop, NextToAnUprightWallLandsOnItsEdge) {
  const Mesh plate = mesh::box_mesh({-10, -10, 0}, {10, 10, 4});
  const DropCutter ball(plate, cutters::ball(6, 30)), flat(plate, cutters::flat(6, 30));
  EXPECT_NEAR(ball({12, 0, 0}).height, 4 - 3 + std::sqrt(9 - 4), 1e-12);
  EXPECT_NEAR(flat({13, 0, 0}).height, 4, 1e-12) << "touching counts";
  EXPECT_FALSE(flat({13 + 1e-9, 0, 0}).touches);
  EXPECT_NEAR(ball({11, 12, 0}).height, 4 - 3 + std::sqrt(9 - 5), 1e-12) << "its corner";
}

TEST(Drop, HangsByTheHolderIfThatTouchesFirst) {
  const Tool tool = cutters::ball(6, 20).with_holder({{20, 12, 60, 12}});
  const DropCutter drop(mesh::box_mesh({8, -10, 0}, {12, 10, 50}), tool);
  EXPECT_NEAR(drop({0, 0, 0}).height, 30, 1e-12);
  EXPECT_EQ(drop({0, 0, 0}).part, tool::Part::Holder);
}

TEST(Drop, OfNeedlesAndTrianglesWithoutAreaIsTheirEdge) {
  const Tool tool = cutters::fillet(8, 1, 30);
  const Mesh flat = triangle({-5, 1, 2}, {5, 1, 2}, {0, 1, 2}),
             needle = triangle({-5, 1, 2}, {5, 1, 2}, {0, 1 + 1e-13, 2});
  const Mesh point = triangle({1, 1, 2}, {1, 1, 2}, {1, 1, 2}),
             wall = triangle({-5, 3.5, 2}, {5, 3.5, 2}, {0, 3.5, -7});
  EXPECT_NEAR(DropCutter(flat, tool)({0, 0, 0}).height, 2, 1e-12);
  EXPECT_NEAR(DropCutter(needle, tool)({0, 0, 0}).height, 2, 1e-12);
  EXPECT_NEAR(DropCutter(point, tool)({0, 0, 0}).height, 2, 1e-12);
  EXPECT_NEAR(DropCutter(wall, tool)({0, 0, 0}).height, 2 - (1 - std::sqrt(1 - 0.25)), 1e-12);
}

TEST(Drop, TouchesAndDoesNotEnterAnyTriangle) {
  stress::Random random(4);
  for (const Tool& tool : named_cutters()) {
    if (tool.name() == "hollow" || tool.name() == "disc on a neck") continue;
    SCOPED_TRACE(tool.name());
    const reference::CutterDistance reference(tool.profile());
    for (int n = 0; n < 400; ++n) {
      const double far = n % 4 ? 0 : 1e5;
      const Vec3 shift(far, -far, far);
      const auto point = [&] {
        return Vec3(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-6, 6)) + shift;
      };
      const Vec3 a = point(), b = point(), c = n % 5 ? point() : glm::mix(a, b, 0.3);
      const DropCutter::Landing landing = DropCutter(triangle(a, b, c), tool)(shift);
      if (!landing.touches) continue;
      const auto distance = [&](const Vec3& p) {
        return reference.distance(std::hypot(p.x - shift.x, p.y - shift.y), p.z - landing.height);
      };
      EXPECT_NEAR(distance(landing.point), 0, far > 0 ? 1e-6 : 1e-9) << n;
      for (int i = 0; i < 100; ++i) {
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        ASSERT_GT(distance(a + u * (b - a) + v * (c - a)), far > 0 ? -1e-6 : -1e-9) << n;
      }
    }
  }
}

TEST(Drop, StopsAboveWhatIsLowerThanWhereItLands) {
  const Mesh part = mesh::moved(mesh::sphere_mesh(7, 3), {1, -2, 3});
  stress::Random random(6);
  for (const Tool& tool : named_cutters()) {
    const DropCutter drop(part, tool, {0, 0, 1}, 0.3);
    for (int n = 0; n < 60; ++n) {
      const Vec3 p(random.uniform(-12, 14), random.uniform(-14, 10), 0);
      const DropCutter::Landing found = drop(p);
      for (const double height : {-20.0, 3.0, found.height - 1e-9, found.height, 20.0})
        ASSERT_EQ(drop.stops_above(p, height), found.touches && found.height > height) << tool.name() << ' ' << height;
    }
  }
}

TEST(Drop, AlongAnyAxisIsThatOfTheTurnedPart) {
  stress::Random random(6);
  const Mesh hills =
      mesh::sheet_mesh(12, 30, [](double x, double y) { return 2 * std::sin(0.5 * x) * std::cos(0.4 * y); });
  for (const Tool& tool : named_cutters()) {
    const Vec3 axis = random.direction(), x = random.square_to(axis);
    const Mat3 turn(x, glm::cross(axis, x), axis);
    Mesh turned = hills;
    for (Vec3& v : turned.vertices) v = turn * v;
    const DropCutter drop(turned, tool, axis), straight(hills, tool);
    for (int n = 0; n < 50; ++n) {
      const Vec3 p(random.uniform(0, 30), random.uniform(0, 30), random.uniform(-5, 5));
      EXPECT_NEAR(drop(turn * p).height, straight(p).height, 1e-11);
    }
  }
}

TEST(Drop, VisitsOnlyNearTrianglesAndIsTheSameInBulk) {
  const Mesh hills =
      mesh::sheet_mesh(200, 100, [](double x, double y) { return 2 * std::sin(0.5 * x) * std::cos(0.4 * y); });
  const DropCutter drop(hills, cutters::ball(6, 30));
  std::vector<Vec3> points;
  for (int n = 0; n < 500; ++n) points.emplace_back(5 + 0.18 * n, 50 + 0.07 * n, 0);
  DropCutter::Stats stats;
  const std::vector<DropCutter::Landing> all = drop(points);
  for (std::size_t n = 0; n < points.size(); ++n) EXPECT_EQ(drop(points[n], &stats).height, all[n].height);
  EXPECT_LT(stats.triangles, 200 * points.size()) << "of 80 000, 226 under the ball";
}

}  // namespace
}  // namespace riffler::plan::drop_test
