#include "collide/swept_search.hpp"

#include <gtest/gtest.h>

#include "collide/outline_lanes.hpp"
#include "collide/tools.hpp"
#include "mesh/shapes.hpp"
#include "reference/assembly_distance.hpp"
#include "reference/surface_entry.hpp"
#include "riffler/collide/collider.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"

namespace riffler::collide::swept_search_test {
namespace {

using Answer = Swept::Answer;
using stress::Random;

const Vec3 kUp(0, 0, 1);

TEST(SweptSearch, WithoutMotionIsTheClearance) {
  const Collider collider(mesh::box_mesh({-20, -20, -5}, {20, 20, 0}));
  const Assembly ball(cutters::ball(6, 20));
  const Motion still({{0, 0, 1}, kUp}, {{0, 0, 1}, kUp});
  EXPECT_EQ(collider.sweep(ball, still, 1, 1000).answer, Answer::Clear);
  EXPECT_GE(collider.sweep(ball, still, 1 - 1e-9, 1000).bound, 1 - 1e-9);
  const Swept gouges = collider.sweep(ball, still, 1 + 1e-9, 1000);
  EXPECT_EQ(gouges.answer, Answer::Gouges);
  EXPECT_NEAR(gouges.clearance, 1, 1e-12);
}

TEST(SweptSearch, FindsAPostThatEndPosesStepOver) {
  const Collider collider(mesh::box_mesh({-0.1, -0.1, -5}, {0.1, 0.1, 5}));
  const Assembly ball(cutters::ball(6, 20));
  const Motion past({{-50, 2.9, 0}, kUp}, {{50, 2.9, 0}, kUp});
  const Swept check = collider.sweep(ball, past, -0.01, 100000);
  EXPECT_EQ(check.answer, Answer::Gouges);
  EXPECT_LT(std::abs(past.tip(check.at).x), 3);
  const Motion beside({{-50, 3.2, 0}, kUp}, {{50, 3.2, 0}, kUp});
  EXPECT_EQ(collider.sweep(ball, beside, 0.1 - 1e-9, 100000).answer, Answer::Clear);
  EXPECT_EQ(collider.sweep(ball, beside, 0.1 - 1e-9, 0).answer, Answer::Unknown);
}

TEST(SweptSearch, SearchesAHolderThatTurnsWhileTheTipStands) {
  const Tool tool = cutters::ball(6, 20).with_holder({{40, 5, 60, 5}});
  const Collider collider(mesh::box_mesh({30, -2, 30}, {40, 2, 45}));
  const Motion turn({{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {1, 0, 0}});
  EXPECT_EQ(collider.sweep(Assembly(tool), turn, 0, 100000).answer, Answer::Gouges);
  EXPECT_EQ(collider.sweep(Assembly(cutters::ball(6, 20)), turn, 0, 100000).answer, Answer::Clear);
}

TEST(SweptSearch, SlidesAlongAPlaneAndACornerInAFewSteps) {
  // Looks at poses alone would need one every two tolerances: 2 500 for 50 mm.
  const Collider corner(both(mesh::box_mesh({-60, -30, -5}, {60, 30, 0}), mesh::box_mesh({-60, 3, -5}, {60, 30, 30})));
  const Assembly ball(cutters::ball(6, 20));
  const Motion along({{-25, 0, 0}, kUp}, {{25, 0, 0}, kUp});
  const Swept straight = corner.sweep(ball, along, -0.01, 100000);
  EXPECT_EQ(straight.answer, Answer::Clear);
  EXPECT_LT(straight.evaluations, 60U);
  const Motion turning({{-25, 0, 0}, kUp}, {{25, 0, 0}, glm::normalize(Vec3(0.3, -0.3, 1))});
  const Swept turned = corner.sweep(Assembly(cutters::ball(6, 20)), turning, -3.5, 100000);
  EXPECT_EQ(turned.answer, Answer::Clear);
}

TEST(SweptSearch, SlidesInAFewStepsUnderAShankThatIsThinnerThanTheCutter) {
  // The tangents at the end of such a shank lead through the cutter's tip.
  const Collider plate(mesh::box_mesh({-60, -30, -5}, {60, 30, 0}));
  const Assembly tool(cutters::ball(6, 10).with_shank({{10, 2.5, 16, 2.5}}).with_holder({{16, 8, 50, 8}}));
  for (const double tilt : {0.0, 0.1, 0.5}) {
    const Vec3 axis(0, std::sin(tilt), std::cos(tilt)), centre(0, 0, 3);
    const Motion along({centre - Vec3(15, 0, 0) - 3.0 * axis, axis}, {centre + Vec3(15, 0, 0) - 3.0 * axis, axis});
    const Swept check = plate.sweep(tool, along, -0.01, 100000);
    EXPECT_EQ(check.answer, Answer::Clear) << tilt;
    EXPECT_LT(check.evaluations, 5000U) << tilt;  // over 100 000 without the disc
  }
}

TEST(SweptSearch, EndsOnTrianglesThatAreSinglePoints) {
  // Their spheres have no size, which the drift exceeds in any stretch.
  Mesh points = mesh::box_mesh({-30, -30, -20}, {30, 30, -10});
  for (const Vec3& p : {Vec3(0, 3.2, 1), Vec3(0, 3.005, 3), Vec3(5, 0, -9)}) {
    const int first = static_cast<int>(points.vertices.size());
    for (int k = 0; k < 200; ++k) {
      points.vertices.push_back(p);
      points.triangles.emplace_back(first, first, first);
    }
  }
  const Collider collider(points);
  const Assembly ball(cutters::ball(6, 20));
  const auto sweep = [&](double y, double wanted) {
    return collider.sweep(ball, Motion({{-500, y, 0}, kUp}, {{500, y, 0}, kUp}), wanted, 100000);
  };
  EXPECT_EQ(sweep(0, 0).answer, Answer::Clear);
  EXPECT_EQ(sweep(0, 0.01).answer, Answer::Gouges);
  EXPECT_EQ(sweep(0.1, 0).answer, Answer::Gouges);
  EXPECT_LT(sweep(0, 0).evaluations, 10000U);
}

TEST(SweptSearch, TakesFewStepsForALongRapidPastASmallPart) {
  const Collider collider(mesh::sphere_mesh(10, 5));
  const Assembly tool(cutters::ball(6, 20).with_holder({{40, 20, 80, 20}}));
  const Swept swept = collider.sweep(tool, Motion({{-2000, 0, 10.5}, kUp}, {{2000, 0, 10.5}, kUp}), 0.4, 100000);
  EXPECT_EQ(swept.answer, Answer::Clear);
  EXPECT_LT(swept.evaluations, 10000U);
}

/// How much of the surface is how deep in the tool, by branch and bound that shares no code, at many poses.
double least_clearance(const Mesh& mesh, const Tool& tool, const Motion& motion, int poses, std::size_t most = 4000) {
  std::vector<reference::Corners> triangles;
  for (const Vec3i& t : mesh.triangles)
    triangles.push_back({mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]});
  std::vector<Pose> at;
  for (int k = 0; k <= poses; ++k) at.push_back(motion.at(static_cast<double>(k) / poses));
  double least = std::numeric_limits<double>::infinity();
  for (const reference::Entry& e : reference::entries(triangles, reference::AssemblyDistance(tool), at, 1e-6, most))
    least = std::min(least, -e.attained);
  return least;
}

/// Half a cone of long needles, from a base of radius 40 mm to its apex.
Mesh cone_of_needles(int count) {
  Mesh cone;
  cone.vertices = {{0, 0, -20}, {0, 0, 60}};
  for (int k = 0; k <= count; ++k) {
    const double a = kPi * k / count;
    cone.vertices.emplace_back(40 * std::cos(a), -40 * std::sin(a), -20);
  }
  for (int k = 0; k < count; ++k)
    cone.triangles.emplace_back(1, 3 + k, 2 + k), cone.triangles.emplace_back(0, 2 + k, 3 + k);
  cone.triangles.emplace_back(1, 0, 2 + count), cone.triangles.emplace_back(1, 2, 0);
  return cone;
}

TEST(SweptSearch, DividesNeedlesThatExtendPastAHollowOfTheTool) {
  // The tool slides up a needle on its ball and its holder's edge. A plane at the ball bounds nothing where the needle
  // passes the neck, so that shorter intervals alone do not help.
  const Tool tool = cutters::ball(6, 22).with_shank({{22, 3, 34, 3}, {34, 3, 42, 8}}).with_holder({{42, 13, 70, 16}});
  const Assembly assembly(tool);
  const Mesh mesh = cone_of_needles(60);
  const Collider collider(mesh);
  const Vec3 base(0, -40, -20), along = glm::normalize(Vec3(0, 40, 80)), out = glm::normalize(Vec3(0, -80, 40));
  Random random(900);
  for (int n = 0; n < test::cases(8); ++n) {
    const auto pose = [&](double up) {
      const double lean = std::atan2(10, 39) + random.uniform(-1e-3, 1e-3);
      const Vec3 axis = std::cos(lean) * along + std::sin(lean) * out;
      return Pose{base + up * along + (3 - random.uniform(1e-3, 0.01)) * out - 3.0 * axis, axis};
    };
    const double up = random.uniform(4, 10);
    const Motion motion(pose(up), pose(up + random.uniform(0.5, 8)));
    const double least = least_clearance(mesh, tool, motion, 40, 100000);
    ASSERT_LT(least, 0) << n;
    const Swept below = collider.sweep(assembly, motion, least - 0.005, 100000);
    EXPECT_EQ(below.answer, Answer::Clear) << n;
    EXPECT_LE(below.bound, least + 1e-6) << n;
    EXPECT_LT(below.evaluations, 3000U) << n;
    EXPECT_EQ(collider.sweep(assembly, motion, least + 1e-3, 100000).answer, Answer::Gouges) << n;
  }
}

TEST(SweptSearch, IsNeverClearIfAPoseOfTheMotionIsNearer) {
  std::uint64_t seed = 700;
  int clear = 0, gouges = 0;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const Assembly assembly(tool);
    Random random(++seed);
    const Mesh mesh = mesh::torus_mesh(12, 4, 24, 12);
    const Collider collider(mesh);
    for (int n = 0; n < 12; ++n) {
      const auto pose = [&] { return Pose{random.uniform(0, 22) * random.direction(), random.direction()}; };
      const Pose from = pose(), aside = pose();
      const double size = random.power_of_ten(-3, 0);
      const Motion motion(from, {from.tip + size * (aside.tip - from.tip),
                                 glm::normalize(from.axis + 0.9 * size * (aside.axis - from.axis))});
      const double least = least_clearance(mesh, tool, motion, 64);
      // What is deep in the tool is known by depth alone; the reference gives where the surface enters.
      const double wanted = std::min(least, -0.0) - 1e-3;
      for (const double by : {1e-3, 0.1, 0.5}) {
        const Swept swept = collider.sweep(assembly, motion, wanted - by, 1000000);
        if (swept.answer == Answer::Gouges) {
          ++gouges;
          EXPECT_NEAR(collider.nearest(assembly, motion.at(swept.at)).distance, swept.clearance, 1e-3);
          EXPECT_LT(swept.clearance, wanted - by);
        }
        clear += swept.answer == Answer::Clear;
        EXPECT_NE(swept.answer, Answer::Unknown);
      }
      if (least < 0) {
        EXPECT_EQ(collider.sweep(assembly, motion, least + 1e-3, 1000000).answer, Answer::Gouges) << n << " " << least;
      }
    }
  }
  EXPECT_GT(clear, 100);
}

TEST(SweptSearch, BoundsOfTrianglesInAnIntervalAreNeverAboveAnyOfItsPoses) {
  std::uint64_t seed = 800;
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const Assembly assembly(tool);
    Random random(++seed);
    for (int n = 0; n < 400; ++n) {
      const Vec3 axis = random.direction();
      const Pose from{5.0 * random.direction(), axis};
      const double size = random.power_of_ten(-4, 0.5);
      const Motion motion(from,
                          {from.tip + size * random.direction(),
                           glm::normalize(axis + std::min(1.0, size) * random.uniform(0, 1) * random.direction())});
      const ToolFrame frame(motion.at(0.5));
      const Drift drift(motion, 1, assembly.reach());
      const tool::OutlineEdge& e = assembly.outline().edges()[n % assembly.outline().edges().size()];
      const Vec2 p = glm::mix(e.from, e.to, random.uniform());
      const double angle = random.uniform(0, 6.3), wide = random.power_of_ten(-2, 1);
      const Vec3 near =
          Vec3(p.x * std::cos(angle), p.x * std::sin(angle), p.y) + 2.0 * random.uniform() * random.direction();
      const auto corner = [&] { return frame.to_part(near + wide * random.direction()); };
      const Corners c{corner(), corner(), corner()};
      SphereGroup group;
      group.put(0, round_triangle(c.a, c.b, c.c));
      const std::vector<Corners> eight(base::kLanes, c);
      double distance[base::kLanes], low[base::kLanes];
      centre_distances(assembly.lane_edges(), frame, group, distance);
      triangle_bounds(assembly.runs(), assembly.lane_edges(), frame, group, eight.data(), &drift, distance, low);
      TriangleSearch search(assembly.runs());
      const double by_triangle =
          search.bound({frame.to_tool(c.a), frame.to_tool(c.b), frame.to_tool(c.c)}, drift.in(frame));
      for (int k = 0; k < 60; ++k) {
        double s = random.uniform(), u = random.uniform();
        if (s + u > 1) s = 1 - s, u = 1 - u;
        const ToolFrame at(motion.at(k < 2 ? k : random.uniform()));
        const Vec3 q = at.to_tool(c.a + s * (c.b - c.a) + u * (c.c - c.a));
        const double there = assembly.outline().nearest(std::hypot(q.x, q.y), q.z).distance;
        ASSERT_LE(low[0], there + 1e-9) << n;
        ASSERT_LE(by_triangle, there + 1e-9) << n;
      }
    }
  }
}

}  // namespace
}  // namespace riffler::collide::swept_search_test
