#include "riffler/collide/collider.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "collide/tools.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "stress/random.hpp"
#include "support/box_mesh.hpp"
#include "support/effort.hpp"
#include "sweep/kernels.hpp"

namespace riffler::collide::collider_test {
namespace {

constexpr auto box = test::box_mesh;

using stress::Random;

Mesh wavy(int n, double size, const Vec3& offset = Vec3(0)) {
  Mesh m;
  const auto ridge = [](double t) { return std::abs(2 * (t - std::floor(t)) - 1); };
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const double x = size * i / n, y = size * j / n;
      m.vertices.push_back(Vec3(x, y, 4 * ridge(x / 17) + 3 * ridge((0.6 * x + 0.8 * y) / 23)) + offset);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      m.triangles.push_back({a, b, b + 1}), m.triangles.push_back({a, b + 1, a + 1});
    }
  return m;
}

Pose tilted(const Vec3& tip, Random& random, double most) {
  const double tilt = random.uniform(0, most), turn = random.uniform(0, 6.3);
  return {tip, {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)}};
}

double distance_at(const tool::Outline& outline, const Pose& pose, const Vec3& p) {
  const Vec3 d = p - pose.tip;
  const double z = glm::dot(d, pose.axis);
  return outline.nearest(glm::length(d - z * pose.axis), z).distance;
}

TEST(Collider, ClearanceOverALevelPlaneIsTheTipsHeightOrTheDepthAboveTheTip) {
  const Collider collider(box({-200, -200, -10}, {200, 200, 0}));
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const Assembly assembly(tool);
    for (const double height : {-0.9, -0.01, 0.0, 1e-9, 0.5, 30.0})
      EXPECT_NEAR(collider.clearance(assembly, {{3, 4, height}, {0, 0, 1}}),
                  height >= 0 ? height : assembly.outline().nearest(0, -height).distance, 1e-9)
          << height;
  }
}

TEST(Collider, ClearanceOfATiltedToolOverAPlaneIsThatOfItsLowestPoint) {
  const Collider collider(box({-500, -500, -300}, {500, 500, 0}));
  Random random(3);
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const Assembly assembly(tool);
    for (int n = 0; n < 50; ++n) {
      const Pose pose = tilted({0, 0, 0}, random, 1.5);
      const double rise = pose.axis.z, side = std::sqrt(1 - rise * rise);
      double lowest = 0;
      for (const tool::OutlineEdge& e : assembly.outline().edges()) {
        lowest = std::min({lowest, e.from.y * rise - e.from.x * side, e.to.y * rise - e.to.x * side});
        if (!e.centre || e.bulge < 0) continue;
        const Vec2 foot = *e.centre + e.bulge * Vec2(side, -rise);
        if (foot.y >= e.from.y && foot.y <= e.to.y) lowest = std::min(lowest, foot.y * rise - foot.x * side);
      }
      const double height = 2 - lowest;
      EXPECT_NEAR(collider.clearance(assembly, {{0, 0, height}, pose.axis}), 2, 1e-9);
    }
  }
}

TEST(Collider, NearestIsOnThePartAndNoOtherPointIsNearer) {
  const Mesh mesh = wavy(40, 40);
  const Collider collider(mesh);
  Random random(4);
  for (const Tool& tool : contact_tools()) {
    SCOPED_TRACE(tool.name());
    const Assembly assembly(tool);
    for (int n = 0; n < 20; ++n) {
      const Pose pose = tilted({random.uniform(5, 35), random.uniform(5, 35), random.uniform(0, 9)}, random, 0.6);
      const Collider::Nearest at = collider.nearest(assembly, pose);
      ASSERT_NEAR(distance_at(assembly.outline(), pose, at.point), at.distance, 1e-9);
      for (int k = 0; k < 4000; ++k) {
        const Vec3i& t = mesh.triangles[random.below(static_cast<int>(mesh.triangles.size()))];
        double s = random.uniform(), u = random.uniform();
        if (s + u > 1) s = 1 - s, u = 1 - u;
        const Vec3 p = mesh.vertices[t.x] + s * (mesh.vertices[t.y] - mesh.vertices[t.x]) +
                       u * (mesh.vertices[t.z] - mesh.vertices[t.x]);
        ASSERT_GE(distance_at(assembly.outline(), pose, p), at.distance - 1e-9);
      }
    }
  }
}

TEST(Collider, KeepsADistanceExactlyIfTheSmallestOneDoesAndSearchesNoDeeper) {
  // A holder deep in a block of long triangles, next to the block, and everywhere between.
  Mesh part;
  for (int k = 0; k <= 40; ++k)
    for (const double y : {-60.0, 60.0}) part.vertices.emplace_back(k - 20.0, y, 3 * std::sin(0.9 * k));
  for (int k = 0; k < 40; ++k)
    part.triangles.emplace_back(2 * k, 2 * k + 2, 2 * k + 1),
        part.triangles.emplace_back(2 * k + 1, 2 * k + 2, 2 * k + 3);
  const Collider collider(part, {Volume::block({{{30, -20, -10}, {40, 20, 10}}, 1, "xyz"})});
  const Assembly assembly(cutters::ball(6, 22).with_shank({{22, 3, 34, 3}}).with_holder({{34, 13, 70, 16}}));
  stress::Random random(12);
  int kept = 0;
  for (int k = 0; k < test::cases(400); ++k) {
    const Pose pose{{random.uniform(-25, 35), random.uniform(-20, 20), random.uniform(-30, 20)}, random.direction()};
    const double nearest = collider.nearest(assembly, pose).distance;
    for (const double wanted : {-5.0, -0.01, 0.0, 1.0, nearest - 1e-6, nearest + 1e-6})
      EXPECT_EQ(collider.keeps(assembly, pose, wanted), nearest >= wanted) << k << ", " << wanted;
    kept += nearest >= 0;
  }
  EXPECT_GT(kept, test::cases(20));
  EXPECT_LT(kept, test::cases(380));
}

TEST(Collider, TheBoundAfterAnExhaustedBudgetIsNeverViolated) {
  const Collider collider(wavy(120, 60));
  const Assembly assembly(held(cutters::ball(6, 20)));
  Random random(5);
  int cut_short = 0;
  for (int n = 0; n < 600; ++n) {
    const Pose pose = tilted({random.uniform(5, 55), random.uniform(5, 55), random.uniform(0, 6)}, random, 0.6);
    const Contact full = collider.query(assembly, pose);
    EXPECT_EQ(full.checked, 1);
    EXPECT_LE(full.missed_depth_bound, full.depth < 1 ? 1e-9 : 1e-4);
    for (const double budget : {0.0, 2e-6, 1e-5, 4e-5}) {
      const Contact some = collider.query(assembly, pose, budget);
      ASSERT_LE(full.depth, some.depth + some.missed_depth_bound);
      ASSERT_LE(some.depth, full.depth + 1e-9);
      ASSERT_TRUE(some.checked >= 0 && some.checked <= 1);
      cut_short += some.checked < 1;
    }
  }
  EXPECT_GT(cut_short, 100);
}

TEST(Collider, ALooseDepthIsWithinItsBoundAndTheForceIsTheSame) {
  const Collider collider(wavy(120, 60));
  const Assembly assembly(held(cutters::ball(6, 20)));
  Random random(6);
  Contact loose;
  for (int n = 0; n < 300; ++n) {
    const Pose pose = tilted({random.uniform(5, 55), random.uniform(5, 55), random.uniform(0, 6)}, random, 0.6);
    const Contact full = collider.query(assembly, pose);
    collider.query(assembly, pose, {}, loose, 0.01);
    ASSERT_LE(full.depth, loose.depth + loose.missed_depth_bound);
    ASSERT_LE(loose.depth, full.depth + 1e-9);
    ASSERT_LE(loose.missed_depth_bound, 0.01 + 1e-3);
    if (loose.depth > 0) {
      ASSERT_EQ(loose.force, full.force);
    }
  }
}

TEST(Collider, StiffnessIsTheDerivativeOfForceAndTorque) {
  // On a plane the normals are the same for tool and part as far as the ball is shallow.
  const Collider collider(box({-12, -12, -5}, {12, 12, 0}), {}, {.spacing = 0.05, .stiffness = 3});
  const Assembly ball(cutters::ball(20, 30));
  const Pose pose{{0.3, -0.2, -0.1}, {0, 0, 1}};
  const Contact at = collider.query(ball, pose);
  const double e = 1e-3;
  const Contact up = collider.query(ball, {pose.tip + Vec3(0, 0, e), pose.axis});
  const Contact down = collider.query(ball, {pose.tip - Vec3(0, 0, e), pose.axis});
  EXPECT_NEAR(at.stiffness[2][2], (down.force.z - up.force.z) / (2 * e), 0.01 * at.stiffness[2][2]);
  EXPECT_NEAR(at.stiffness[0][0], 0, 1e-9);
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) EXPECT_DOUBLE_EQ(at.stiffness[i][j], at.stiffness[j][i]);
}

struct Dense {
  Vec3 force{0}, torque{0};  // the torque about the tip
};

/// ∫ depth n dA by very many points of a fine grid over each triangle.
Dense dense_wrench(const Mesh& mesh, const tool::Outline& outline, const Pose& pose, int n) {
  Dense sum;
  for (const Vec3i& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    const Vec3 area = 0.5 * glm::cross(b - a, c - a) / static_cast<double>(n * n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2 * (n - i) - 1; ++j) {
        const double shift = j % 2 ? 2.0 / 3 : 1.0 / 3;
        const Vec3 p = a + (i + shift) / n * (b - a) + (j / 2 + shift) / n * (c - a);
        const Vec3 force = std::max(0.0, -distance_at(outline, pose, p)) * area;
        sum.force += force, sum.torque += glm::cross(p - pose.tip, force);
      }
  }
  return sum;
}

TEST(Collider, ForceAndTorqueConvergeToTheIntegralOfDepthOverTheSurface) {
  const Mesh mesh = wavy(20, 10);
  const Assembly assembly(cutters::ball(6, 30));
  Random random(7);
  std::vector<double> errors, turning;
  std::vector<Dense> dense;  // the poses are the same for every spacing
  for (const double spacing : {0.4, 0.2, 0.1, 0.05}) {
    const Collider collider(mesh, {}, {.spacing = spacing});
    double worst = 0, worst_turning = 0;
    random = Random(7);
    for (int n = 0; n < test::cases(6); ++n) {
      const Pose pose = tilted({random.uniform(4, 6), random.uniform(4, 6), random.uniform(2, 4)}, random, 0.4);
      const Contact c = collider.query(assembly, pose);
      if (n == std::ssize(dense)) dense.push_back(dense_wrench(mesh, assembly.outline(), pose, 60));
      const Dense& expected = dense[n];
      const double size = glm::length(expected.force);
      if (!(size > 0.1)) continue;
      worst = std::max(worst, glm::length(c.force - expected.force) / size);
      // A torque may vanish where its parts do not: relative to the force at the ball's radius.
      worst_turning = std::max(worst_turning, glm::length(c.torque - expected.torque) / (3 * size));
    }
    errors.push_back(worst), turning.push_back(worst_turning);
  }
  // The worst of a few poses does not fall steadily; over three halvings it does.
  for (const std::vector<double>& of : {errors, turning}) {
    EXPECT_LT(of.front(), 1e-2);
    EXPECT_LT(of.back(), 0.25 * of.front());
    EXPECT_LT(of.back(), 1e-3);
  }
}

TEST(Collider, DenseTrianglesAreGatheredAndLargeOnesSplit) {
  const Assembly assembly(cutters::ball(6, 30));
  const Pose pose{{5, 5, -0.3}, {0, 0, 1}};
  const Collider large(box({-5, -5, -5}, {15, 15, 0}), {}, {.spacing = 0.1});
  Mesh flat;
  const int n = 400;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) flat.vertices.push_back({10.0 * i / n, 10.0 * j / n, 0});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      flat.triangles.push_back({a, b, b + 1}), flat.triangles.push_back({a, b + 1, a + 1});
    }
  const Collider dense(flat, {}, {.spacing = 0.1});
  EXPECT_LT(dense.points(), flat.triangles.size() / 4);
  // A cap of the ball, d deep: ∫ (depth) over its disc, depth R − √(r² + (R − d)²).
  const double r = 3, d = 0.3, wide = std::sqrt(2 * r * d - d * d), up = r - d;
  const double exact = 3.14159265358979 * (r * wide * wide - 2.0 / 3 * (r * r * r - up * up * up));
  for (const Collider* c : {&large, &dense}) {
    const Contact at = c->query(assembly, pose);
    EXPECT_NEAR(at.depth, d, 1e-9);
    EXPECT_NEAR(at.force.z, exact, 5e-3 * exact);
    EXPECT_LT(std::hypot(at.force.x, at.force.y), 5e-3 * exact);
  }
}

TEST(Collider, ForceIsContinuousOverAnEdgeAndWhereTheCutterEnds) {
  const Collider collider(box({-40, -40, -30}, {0, 40, 0}), {}, {.spacing = 0.25});
  const Assembly ball(held(cutters::ball(6, 8)));
  // Down along the edge, so that cutter, shank and taper meet it one after the other, and across it.
  for (const auto& [from, to] :
       {std::pair(Vec3(2.6, 0, 2), Vec3(2.6, 0, -18)), std::pair(Vec3(4, 1, -1), Vec3(-4, 1, -0.4))}) {
    Vec3 last(0);
    double largest = 0, step = 0;
    const int n = test::cases(8000);
    for (int k = 0; k <= n; ++k) {
      const Contact c = collider.query(ball, {glm::mix(from, to, k / double(n)), {0, 0, 1}});
      if (k > 0) step = std::max(step, glm::length(c.force - last));
      last = c.force, largest = std::max(largest, glm::length(last));
    }
    EXPECT_GT(largest, 1);
    EXPECT_LT(step, 80.0 / n * largest);
  }
}

TEST(Collider, ForcePushesOutAndTorqueIsAboutTheTip) {
  const Collider collider(box({-40, -40, -30}, {0, 40, 30}), {}, {.spacing = 0.2});
  const Assembly ball(cutters::ball(6, 20));
  const Contact c = collider.query(ball, {{2.8, 0, 0}, {0, 0, 1}});
  EXPECT_NEAR(c.depth, 0.2, 1e-9);
  EXPECT_GT(c.force.x, 0);
  EXPECT_NEAR(c.force.z, 0, 1e-9);
  // The wall is met between the heights 3 and 20, a little less where the ball is.
  EXPECT_NEAR(c.torque.y / c.force.x, 11.4, 0.3);
  ASSERT_EQ(c.points.size(), c.touches.size());
  EXPECT_NEAR(distance_at(ball.outline(), {{2.8, 0, 0}, {0, 0, 1}}, c.points[0]), -0.2, 1e-9);
}

Volume block(const Vec3& lower, const Vec3& upper, double pitch, const char* directions = "xyz") {
  return Volume::block({{lower, upper}, pitch, directions});
}

TEST(Collider, FixturesCollideWithTheirInsideToo) {
  const Mesh part = box({-5, -5, -5}, {5, 5, 0});
  const Collider collider(part, {block({20, 0, 0}, {30, 10, 10}, 1), block({100, 100, 100}, {400, 400, 400}, 10, "z")});
  const Assembly assembly(cutters::ball(6, 30));
  const auto outside = collider.nearest(assembly, {{25, 5, 12}, {0, 0, 1}});
  EXPECT_NEAR(outside.distance, 2, 1e-5);
  EXPECT_EQ(outside.touch, Touch::Fixture);
  EXPECT_NEAR(collider.nearest(assembly, {{25, 5, 9}, {0, 0, 1}}).distance, -1, 1e-5);
  // Wholly inside the second, and as deep as the cutter is thick.
  const auto inside = collider.nearest(assembly, {{250, 250, 200}, {0, 0, 1}});
  EXPECT_NEAR(inside.distance, -3, 1e-9);
  EXPECT_EQ(inside.touch, Touch::Fixture);
  EXPECT_GT(collider.clearance(assembly, {{250, 250, 200}, {0, 0, 1}}), 100);
  const Contact none = collider.query(assembly, {{50, 50, 50}, {0, 0, 1}});
  EXPECT_EQ(none.depth, 0);
  EXPECT_TRUE(none.points.empty());
}

TEST(Collider, EachFixtureMayHaveItsOwnStiffness) {
  const Mesh part = box({-500, 0, 0}, {-490, 1, 1});
  const auto two = [] {
    return std::vector<Volume>{block({0, 0, 0}, {20, 20, 10}, 0.5, "z"), block({100, 0, 0}, {120, 20, 10}, 0.5, "z")};
  };
  const Collider alike(part, two(), {.fixture_stiffness = 2});
  const Collider apart(part, two(), {.fixture_stiffness = 1, .stiffness_of_each = {2, 6}});
  const Assembly flat(cutters::flat(6, 30));
  const Pose first{{10, 10, 8}, {0, 0, 1}}, second{{110, 10, 8}, {0, 0, 1}};
  EXPECT_EQ(apart.query(flat, first).force, alike.query(flat, first).force);
  EXPECT_NEAR(apart.query(flat, second).force.z, 3 * alike.query(flat, second).force.z, 1e-9);
  EXPECT_THROW(Collider(part, two(), {.stiffness_of_each = {1}}), std::invalid_argument);
  EXPECT_THROW(Collider(part, two(), {.stiffness_of_each = {1, -1}}), std::invalid_argument);
}

TEST(Collider, FixturesPushByTheirVolumeInTheTool) {
  const Collider collider(box({-500, 0, 0}, {-490, 1, 1}), {block({0, 0, 0}, {20, 20, 10}, 0.5, "z")},
                          {.fixture_stiffness = 2, .fixture_push = Collider::FixturePush::Centre});
  const Assembly flat(cutters::flat(6, 30));
  const Contact c = collider.query(flat, {{10, 10, 8}, {0, 0, 1}});
  // A cylinder 2 mm deep in it: all of it points to the middle of the cutter, 14 to 16 mm above, mostly upwards.
  double expected = 0;
  for (int n = 0; n < 200; ++n) {
    const double z = 14 + (n + 0.5) / 100;
    expected += 2 * 0.01 * 2 * 3.14159265358979 * z * (std::hypot(z, 3) - z);
  }
  EXPECT_NEAR(c.force.z, expected, 5e-3 * expected);
  EXPECT_NEAR(std::hypot(c.force.x, c.force.y), 0, 1e-6);
  EXPECT_NEAR(c.depth, 2, 1e-4);
  EXPECT_EQ(c.touches[0], Touch::Fixture);
}

TEST(Collider, HoldsAtCoordinatesOf1e5AndFarAway) {
  const Vec3 offset(1e5, -1e5, 1e5);
  const Collider near(wavy(60, 40)), far(wavy(60, 40, offset));
  const Assembly assembly(held(cutters::fillet(8, 1, 30)));
  Random random(8);
  for (int n = 0; n < 100; ++n) {
    const Pose pose = tilted({random.uniform(5, 35), random.uniform(5, 35), random.uniform(0, 8)}, random, 0.5);
    EXPECT_NEAR(far.clearance(assembly, {pose.tip + offset, pose.axis}), near.clearance(assembly, pose), 1e-9);
  }
  const double d = near.clearance(assembly, {{1e8, 0, 0}, {0, 0, 1}});
  EXPECT_NEAR(d, 1e8, 100);
}

TEST(Collider, DegenerateTrianglesAndCoincidentWallsGiveFiniteResults) {
  Mesh mesh = box({-5, -5, -5}, {5, 5, 0});
  const int n = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back({1, 1, 0}), mesh.vertices.push_back({2, 1, 0}), mesh.vertices.push_back({3, 1, 1e-13});
  mesh.triangles.push_back({n, n, n}), mesh.triangles.push_back({n, n + 1, n + 1}),
      mesh.triangles.push_back({n, n + 1, n + 2});
  for (int k = 0; k < 12; ++k) mesh.triangles.push_back(mesh.triangles[k]);
  const Collider collider(mesh);
  for (const Tool& tool : contact_tools()) {
    const Assembly assembly(tool);
    for (const double x : {0.0, 1.0, 5.0})
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Contact c = collider.query(assembly, {{x, x, z}, {0, 0, 1}});
        EXPECT_TRUE(geom::finite(c.force) && geom::finite(c.torque) && std::isfinite(c.depth));
      }
  }
}

TEST(Collider, AFlatTopUnderAFlatToolGivesABoundedForce) {
  Mesh flat;
  const int n = 200;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) flat.vertices.push_back({0.2 * i - 20, 0.2 * j - 20, 0});
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j, b = a + n + 1;
      flat.triangles.push_back({a, b, b + 1}), flat.triangles.push_back({a, b + 1, a + 1});
    }
  const Collider collider(flat);
  const Assembly assembly(cutters::flat(12, 30));
  for (const double z : {-0.5, 0.0, 1.0}) {
    Counts counts;
    EXPECT_NEAR(collider.clearance(assembly, {{0, 0, z}, {0, 0, 1}}, counts), z, 1e-9);
    EXPECT_LT(counts.cells, 4 * flat.triangles.size() / 10) << z;
  }
}

TEST(Collider, AwayFromTheCutterFewerPointsGiveTheSameForce) {
  const Mesh mesh = wavy(60, 60);
  const Collider fine(mesh, {}, {.spacing = 0.2, .coarse = 0}), coarse(mesh, {}, {.spacing = 0.2});
  const Assembly assembly(held(cutters::ball(6, 20)));
  Random random(10);
  Counts many, few;
  for (int n = 0; n < 20; ++n) {
    const Pose pose = tilted({random.uniform(20, 40), random.uniform(20, 40), random.uniform(-47, -44)}, random, 0.1);
    const Contact a = fine.query(assembly, pose, {}, many), b = coarse.query(assembly, pose, {}, few);
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_LT(glm::length(a.force - b.force), 0.01 * glm::length(a.force));
    EXPECT_LT(glm::length(a.torque - b.torque), 0.01 * glm::length(a.torque));
  }
  EXPECT_LT(few.points + few.nodes, (many.points + many.nodes) / 4);
}

TEST(Collider, InstructionSetsGiveTheSameBits) {
  const Collider collider(wavy(80, 40));
  const Assembly assembly(held(cutters::fillet(8, 1, 20)));
  std::vector<Contact> first;
  for (const std::string& name : sweep::instruction_sets()) {
    SCOPED_TRACE(name);
    sweep::use_instruction_set(name);
    Random random(11);
    std::vector<Contact> found;
    for (int n = 0; n < 100; ++n)
      found.push_back(collider.query(
          assembly, tilted({random.uniform(5, 35), random.uniform(5, 35), random.uniform(0, 6)}, random, 0.6)));
    if (first.empty()) first = found;
    for (std::size_t n = 0; n < found.size(); ++n) {
      ASSERT_EQ(found[n].depth, first[n].depth);
      ASSERT_EQ(found[n].force, first[n].force);
      ASSERT_EQ(found[n].points, first[n].points);
    }
  }
  sweep::use_instruction_set("");
}

TEST(Collider, ThreadsGetTheSameAnswers) {
  const Collider collider(wavy(120, 60));
  const Assembly assembly(held(cutters::ball(6, 20)));
  std::vector<Pose> poses;
  Random random(9);
  for (int k = 0; k < 200; ++k) poses.push_back(tilted({random.uniform(5, 55), random.uniform(5, 55), 3}, random, 0.5));
  std::vector<std::vector<Vec3>> forces(4, std::vector<Vec3>(poses.size()));
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t k = 0; k < poses.size(); ++k) forces[t][k] = collider.query(assembly, poses[k]).force;
    });
  for (std::thread& t : threads) t.join();
  for (int t = 1; t < 4; ++t) EXPECT_EQ(forces[t], forces[0]);
}

TEST(Collider, NeedlesAreSampledByTheirAreaNotByTheirLength) {
  Mesh needles;
  for (int k = 0; k < 60; ++k) {
    const int n = static_cast<int>(needles.vertices.size());
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(30, k, 0), Vec3(30, k + 1e-9, 0)}) needles.vertices.push_back(p);
    needles.triangles.push_back({n, n + 1, n + 2});
  }
  EXPECT_LT(Collider(needles).points(), 1'000'000U);
}

TEST(Collider, RefusesInvalidInput) {
  const Mesh part = box({0, 0, 0}, {1, 1, 1});
  EXPECT_THROW(Collider(Mesh{}), std::invalid_argument);
  EXPECT_THROW(Collider(part, {}, {.spacing = -1}), std::invalid_argument);
  EXPECT_THROW(Collider(part, {}, {.spacing = 1e-9}), std::invalid_argument);
  EXPECT_THROW(Collider(part, {}, {.stiffness = NAN}), std::invalid_argument);
  const Collider collider(part);
  const Assembly assembly(cutters::ball(6, 20));
  EXPECT_THROW(collider.clearance(assembly, {{0, 0, 0}, {0, 0, 2}}), std::invalid_argument);
  EXPECT_THROW(collider.query(assembly, {{NAN, 0, 0}, {0, 0, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::collide::collider_test
