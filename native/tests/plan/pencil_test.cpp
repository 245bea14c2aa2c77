#include "riffler/plan/pencil.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "mesh/closest.hpp"
#include "plan/parts.hpp"
#include "riffler/base/error.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"

namespace riffler::plan::pencil_test {
namespace {

const std::vector<PartPlacement> kPlacements{
    {}, PartPlacement::about({1, 2, 3}, 1.1, {0, 0, 0}), PartPlacement::about({-3, 1, 0.4}, 2.7, {1e5, -1e5, 7e4})};

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::length(p - a - t * (b - a));
}

/// Hausdorff distance between a path and a segment, in both directions over points dense enough on straight pieces.
double hausdorff(const PencilPath& path, const Vec3& a, const Vec3& b) {
  double most = 0;
  for (const Vec3& c : path.centres) most = std::max(most, distance_to_segment(c, a, b));
  for (int i = 0; i <= 100; ++i) {
    const Vec3 p = glm::mix(a, b, i / 100.0);
    double least = 1e30;
    for (std::size_t k = 1; k < path.size(); ++k)
      least = std::min(least, distance_to_segment(p, path.centres[k - 1], path.centres[k]));
    most = std::max(most, least);
  }
  return most;
}

/// What every path must be: balls that enter nothing, and touch where they say, with the part's normals.
void expect_rolls(const Mesh& part, const PencilPath& path, double facet) {
  const mesh::Closest closest(part);
  for (std::size_t k = 0; k < path.size(); ++k) {
    const Vec3& c = path.centres[k];
    ASSERT_TRUE(geom::finite(c));
    EXPECT_GE(closest(c).distance, path.radius - 1e-8);
    for (int side = 0; side < 2; ++side) {
      EXPECT_NEAR(glm::length(c - path.contacts[k][side]), path.radius, 1e-8);
      EXPECT_LT(closest(path.contacts[k][side]).distance, 1e-8);
      const Vec3 away = (c - path.contacts[k][side]) / path.radius;
      EXPECT_GE(glm::dot(away, path.normals[k][side]), std::cos(facet) - 1e-9);
    }
    if (k == 0) continue;
    const auto turn = [&](int side, int other) {
      return glm::length(path.normals[k][side] - path.normals[k - 1][other]);
    };
    EXPECT_LE(turn(0, 0) + turn(1, 1), turn(0, 1) + turn(1, 0)) << "sides are exchanged";
  }
}

TEST(Pencil, GroovesOfTwoPlanesGiveTheirLineInAnyTurnAndMesh) {
  const double radius = 3;
  for (const double degrees : {60.0, 90.0, 120.0, 150.0, 170.0})
    for (const int times : {0, 2})
      for (const PartPlacement& place : kPlacements) {
        if (test::kSanitized && degrees != 90) continue;
        const double theta = degrees * kPi / 180, z = -8 + radius / std::sin(theta / 2);
        const Mesh part = place(subdivided(groove(theta), times));
        const PencilResult result = pencil(part, radius);
        ASSERT_EQ(result.paths.size(), 1U) << degrees << " " << times << " " << result.reason;
        EXPECT_LT(hausdorff(result.paths[0], place({0, 0, z}), place({40, 0, z})), 1e-4) << degrees;
        EXPECT_EQ(result.paths[0].size(), 2U);
        EXPECT_FALSE(result.paths[0].closed);
        expect_rolls(part, result.paths[0], 1e-5);
        EXPECT_NEAR(result.rest_area, 80 * radius / std::tan(theta / 2), degrees < 160 ? 1.5 : 8) << degrees;
      }
}

TEST(Pencil, TheOrderOfTrianglesDoesNotDecideWhereAPathBegins) {
  // Joining objects in another order gives the same part with its triangles in another order.
  const PartPlacement turned = PartPlacement::about({0.2, 1, 0.4}, 2.5, {5, -3, 2});
  for (const Mesh& given : {groove(kPi / 2), turned(groove(kPi / 2)), turned(subdivided(groove(kPi / 2), 2))}) {
    Mesh other = given;
    std::reverse(other.triangles.begin(), other.triangles.end());
    for (Vec3i& t : other.triangles) t = {t.y, t.z, t.x};
    const PencilResult a = pencil(given, 3), b = pencil(other, 3);
    ASSERT_EQ(a.paths.size(), 1U);
    ASSERT_EQ(b.paths.size(), 1U);
    EXPECT_LT(a.paths[0].centres.front().x, a.paths[0].centres.back().x);
    EXPECT_LT(glm::distance(a.paths[0].centres.front(), b.paths[0].centres.front()), 1e-5);
    EXPECT_LT(glm::distance(a.paths[0].contacts.front()[0], b.paths[0].contacts.front()[0]), 1e-5);
    EXPECT_LT(glm::distance(a.paths[0].contacts.back()[1], b.paths[0].contacts.back()[1]), 1e-5);
  }
}

TEST(Pencil, GapsWithinTheToleranceAreFaceting) {
  const double radius = 3, gap = 0.01;  // 171 degrees: 0.0093 mm
  for (const double degrees : {171.0, 175.0, 179.9}) {
    const double theta = degrees * kPi / 180;
    ASSERT_LT(radius * (1 / std::sin(theta / 2) - 1), gap);
    const PencilResult result = pencil(groove(theta), radius);
    EXPECT_TRUE(result.paths.empty()) << degrees;
    EXPECT_FALSE(result.reason.empty());
    EXPECT_EQ(pencil(groove(theta), radius, {.tolerance = 1e-4}).paths.size(), degrees < 179 ? 1U : 0U) << degrees;
  }
  EXPECT_NEAR(bitangency_angle_of_gap(radius, radius * (std::sqrt(2.0) - 1)), kPi / 2, 1e-12);
  EXPECT_TRUE(pencil(groove(kPi / 2), radius, {.bitangency_angle = 1.6}).paths.empty());
  EXPECT_EQ(pencil(groove(kPi / 2), radius, {.bitangency_angle = 1.5}).paths.size(), 1U);
}

TEST(Pencil, CurvesOfABoxesInsideMeetInItsCorners) {
  for (const PartPlacement& place : kPlacements) {
    const Mesh part = place(subdivided(inside_out(mesh::box_mesh({0, 0, 0}, {50, 40, 30})), 2));
    const PencilResult result = pencil(part, 3);
    ASSERT_EQ(result.paths.size(), 12U);
    std::vector<Vec3> corners;
    double length = 0;
    for (const PencilPath& path : result.paths) {
      length += path.length();
      for (const Vec3& end : {path.centres.front(), path.centres.back()}) {
        const Vec3 p = place.back(end);
        for (int k = 0; k < 3; ++k) {
          const double upper = 47 - 10.0 * k;
          EXPECT_LT(std::min(std::abs(p[k] - 3), std::abs(p[k] - upper)), 1e-8);
        }
        corners.push_back(end);
      }
      expect_rolls(part, path, 1e-5);
    }
    EXPECT_NEAR(length, 4 * (44 + 34 + 24), 1e-6);
    // Three paths share each corner, bit for bit.
    for (const Vec3& c : corners) EXPECT_EQ(std::count(corners.begin(), corners.end(), c), 3);
  }
}

TEST(Pencil, AroundABossThePathIsOneLoop) {
  const double radius = 3, boss = 10;
  for (const int around : {16, 64, 200}) {
    const Mesh part =
        both(mesh::box_mesh({-40, -40, -5}, {40, 40, 0}), cylinder_mesh(boss, -1, 20, around));  // not welded
    const PencilResult result = pencil(part, radius);
    ASSERT_EQ(result.paths.size(), 1U) << around;
    const PencilPath& path = result.paths[0];
    EXPECT_TRUE(path.closed);
    const double facet = kPi / around, sagitta = boss * (1 - std::cos(facet));
    for (const Vec3& c : path.centres) {
      EXPECT_NEAR(c.z, radius, 1e-9);
      EXPECT_LE(std::hypot(c.x, c.y), boss + radius + 1e-9);
      EXPECT_GE(std::hypot(c.x, c.y), boss + radius - sagitta - 1e-9);
    }
    const double tolerance = PencilOptions{}.tolerance;
    for (std::size_t k = 0; k < path.size(); ++k) {
      const Vec3 middle = 0.5 * (path.centres[k] + path.centres[(k + 1) % path.size()]);
      EXPECT_GE(std::hypot(middle.x, middle.y), boss + radius - sagitta - tolerance);
    }
    const double exact =
        2 * boss * around * std::sin(facet) + 2 * kPi * radius;  // polygon and arcs of the ball's radius
    EXPECT_NEAR(path.length(), exact, 0.002 * exact);
    expect_rolls(part, path, facet);
  }
}

TEST(Pencil, BlendsSmallerThanTheBallGiveAPathAndLargerOnesNone) {
  const double radius = 3, z = -8 + radius * std::sqrt(2.0);
  for (const double blend : {0.5, 1.0, 2.5, 2.9}) {
    if (test::kSanitized && blend != 2.5) continue;
    const PencilResult result = pencil(groove(kPi / 2, 40, blend, 64), radius);
    ASSERT_EQ(result.paths.size(), 1U) << blend;
    EXPECT_LT(hausdorff(result.paths[0], {0, 0, z}, {40, 0, z}), 1e-4);
  }
  for (const double blend : {3.05, 3.5, 5.0}) {
    if (test::kSanitized && blend != 3.5) continue;
    const PencilResult result = pencil(groove(kPi / 2, 40, blend, 64), radius);
    EXPECT_TRUE(result.paths.empty()) << blend;
    EXPECT_LT(result.rest_area, 0.01) << blend;
  }
}

TEST(Pencil, FacetsOfAHollowThatTheBallNearlyFillsAreNoValley) {
  const double radius = 3, quarter = kPi / 4;
  int by_angle = 0;
  for (const double blend : {3.1, 3.2, 3.3, 3.6})
    for (int seed = 0; seed < 5; ++seed) {
      // Turned by up to 8° from facet to facet, as unevenly as can be: the ball rests on facets that are not neighbours
      // and differ by more than the angle at which two planes alone would leave a gap of the tolerance.
      const double z = -8 + blend / std::sin(quarter);
      std::vector<Vec2> outline{{16, 0}, {8, 0}};
      double a = quarter;
      for (int i = 0; a > -quarter; a -= (4.5 + 3.5 * std::sin(1.7 * i * (seed + 1) + seed)) * kPi / 180, ++i)
        outline.emplace_back(blend * std::sin(a), z - blend * std::cos(a));
      outline.emplace_back(-blend * std::sin(quarter), z - blend * std::cos(quarter));
      outline.insert(outline.end(), {{-8, 0}, {-16, 0}});
      const Mesh part = trench(outline, -20, 4);
      EXPECT_TRUE(pencil(part, radius).paths.empty()) << blend << " " << seed;
      const double angle = bitangency_angle_of_gap(radius, PencilOptions{}.tolerance);
      by_angle += pencil(part, radius, {.bitangency_angle = angle}).paths.empty() ? 0 : 1;
    }
  EXPECT_GT(by_angle, 3);
}

TEST(Pencil, AThickerBallFindsBlendsOfNearlyTheSameRadius) {
  const double radius = 3, z = -8 + radius * std::sqrt(2.0);
  const PencilResult sharp = pencil(groove(kPi / 2), radius, {.overthickness = 0.5});
  ASSERT_EQ(sharp.paths.size(), 1U);
  EXPECT_LT(hausdorff(sharp.paths[0], {0, 0, z}, {40, 0, z}), 1e-4);
  EXPECT_EQ(sharp.paths[0].radius, radius);
  const double blend = 3.2;  // the ball lies on the bottom of the blend
  const Mesh part = groove(kPi / 2, 40, blend, 64);
  EXPECT_TRUE(pencil(part, radius).paths.empty());
  const PencilResult found = pencil(part, radius, {.overthickness = 0.5});
  ASSERT_EQ(found.paths.size(), 1U);
  const double bottom = -8 + blend * std::sqrt(2.0) - blend + radius;
  EXPECT_LT(hausdorff(found.paths[0], {0, 0, bottom}, {40, 0, bottom}), 2e-3);
  expect_rolls(part, found.paths[0], 0.02);
}

/// A square pocket from z = 0 to `depth`, open at the top, in a plate of 80 x 80 mm.
Mesh square_pocket(double half, double depth) {
  const double wide = 40;
  Mesh m;
  for (const double z : {0.0, depth})
    for (const Vec2 p : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
      m.vertices.emplace_back(half * p.x, half * p.y, z);
  for (const Vec2 p : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)})
    m.vertices.emplace_back(wide * p.x, wide * p.y, depth);
  const auto quad = [&](int a, int b, int c, int d) {
    m.triangles.emplace_back(a, b, c), m.triangles.emplace_back(a, c, d);
  };
  quad(0, 1, 2, 3);
  for (int k = 0; k < 4; ++k) {
    const int n = (k + 1) % 4;
    quad(n, k, 4 + k, 4 + n), quad(4 + n, 4 + k, 8 + k, 8 + n);
  }
  return m;
}

double length_of(const PencilResult& result) {
  double sum = 0;
  for (const PencilPath& path : result.paths) sum += path.length();
  return sum;
}

/// mm² that a ball cannot reach in a square pocket deeper than its radius: a strip on both sides of every edge, by the
/// faces' areas less what their contacts cover.
double rest_of_pocket(double half, double depth, double r) {
  const double side = 2 * half, reached = side - 2 * r;
  return side * side - reached * reached + 4 * (side * depth - reached * (depth - r));
}

TEST(Pencil, RestOfALargerBallGoesIntoTheCornersOfAPocket) {
  const double half = 20, depth = 8, small = 2, large = 6;
  const Mesh part = square_pocket(half, depth);
  const PencilResult found = pencil(part, small, {.overthickness = large - small});
  // Four edges of the floor and four upright ones, each once, from corner to corner and from corner to rim.
  ASSERT_EQ(found.paths.size(), 8U);
  EXPECT_NEAR(length_of(found), 4 * 2 * (half - small) + 4 * (depth - small), 1e-3);
  int upright = 0;
  for (std::size_t k = 0; k < found.paths.size(); ++k) {
    const PencilPath& path = found.paths[k];
    expect_rolls(part, path, 1e-6);
    const Vec3 along = glm::normalize(path.centres.back() - path.centres.front());
    upright += std::abs(along.z) > 0.5 ? 1 : 0;
    for (const Vec3& c : path.centres) {
      const int walls = (std::abs(std::abs(c.x) - (half - small)) < 1e-6 ? 1 : 0) +
                        (std::abs(std::abs(c.y) - (half - small)) < 1e-6 ? 1 : 0) +
                        (std::abs(c.z - small) < 1e-6 ? 1 : 0);
      EXPECT_GE(walls, 2);
    }
  }
  EXPECT_EQ(upright, 4);
  EXPECT_NEAR(found.rest_area, rest_of_pocket(half, depth, small), 0.03 * found.rest_area);
  EXPECT_NEAR(found.reference_area, rest_of_pocket(half, depth, large), 0.03 * found.reference_area);
  EXPECT_EQ(pencil(part, large).rest_areas, found.reference_areas);
}

TEST(Pencil, RestInABlendRunsOnTowardsItsCorners) {
  // The ball finds no valley in the blend itself; the larger one would end 5 mm before the walls at both ends.
  const double radius = 3, blend = 3.2, length = 40;
  const Mesh trough = groove(kPi / 2, length, blend, 64);
  const Mesh part = both(both(trough, mesh::box_mesh({-10, -30, -30}, {0, 30, 10})),
                         mesh::box_mesh({length, -30, -30}, {length + 10, 30, 10}));
  const PencilResult found = pencil(part, radius, {.overthickness = 2});
  const double bottom = -8 + blend * std::sqrt(2.0) - blend + radius;
  double low = length, high = 0;
  for (const PencilPath& path : found.paths)
    for (const Vec3& c : path.centres) {
      EXPECT_GE(mesh::Closest(part)(c).distance, radius - 1e-6);
      if (std::abs(c.y) < 0.02 && std::abs(c.z - bottom) < 0.02) low = std::min(low, c.x), high = std::max(high, c.x);
    }
  EXPECT_LT(low, radius + 0.6);
  EXPECT_GT(high, length - radius - 0.6);
  // Its line is covered once: no second path next to the first.
  double along = 0;
  for (const PencilPath& path : found.paths)
    for (std::size_t k = 1; k < path.size(); ++k) {
      const Vec3 &a = path.centres[k - 1], &b = path.centres[k];
      if (std::abs(a.y) < 0.02 && std::abs(b.y) < 0.02 && std::abs(a.z - b.z) < 0.02) along += std::abs(b.x - a.x);
    }
  EXPECT_NEAR(along, length - 2 * radius, 4.0);
}

TEST(Pencil, OnlyCuttersWithABallAtTheirTipHavePencilCuts) {
  EXPECT_EQ(tip_ball_radius(cutters::ball(6, 30), "tool"), 3);
  EXPECT_NEAR(tip_ball_radius(cutters::taper(1, 0.1, 6, 40), "tool"), 1, 1e-12);
  for (const Tool& tool : {cutters::flat(6, 30), cutters::fillet(6, 1, 30), cutters::taper(1, 0.1, 6, 40, true),
                           cutters::cone_end(0.5, 1, 0.5, 4, 20)})
    try {
      tip_ball_radius(tool, "reference_tool");
      ADD_FAILURE() << tool.kind();
    } catch (const std::invalid_argument& e) {
      EXPECT_NE(std::string(e.what()).find("reference_tool: "), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("ball end"), std::string::npos) << e.what();
    }
}

/// A dovetail: undercut walls of 60 degrees, from three prisms that are not welded.
Mesh dovetail() {
  const auto wedge = [](double side) {
    Mesh m;
    for (const double x : {0.0, 40.0})
      for (const Vec2 p : {Vec2(6, 0), Vec2(6 + 10 / std::sqrt(3.0), -10), Vec2(30, -10), Vec2(30, 0)})
        m.vertices.emplace_back(x, side * p.x, p.y);
    m.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      m.triangles.emplace_back(i, i + 4, j + 4), m.triangles.emplace_back(i, j + 4, j);
    }
    return side > 0 ? inside_out(m) : m;
  };
  return both(both(wedge(1), wedge(-1)), mesh::box_mesh({0, -30, -20}, {40, 30, -10}));
}

TEST(Pencil, UndercutsAreFound) {
  const double radius = 3, y = 6 + 10 / std::sqrt(3.0) - radius * std::sqrt(3.0);
  for (const PartPlacement& place : kPlacements) {
    const Mesh part = place(dovetail());
    ASSERT_GT(volume(part), 0);
    const PencilResult result = pencil(part, radius);
    ASSERT_EQ(result.paths.size(), 2U) << result.reason;
    for (const PencilPath& path : result.paths) {
      const double side = place.back(path.centres[0]).y > 0 ? y : -y;
      EXPECT_LT(hausdorff(path, place({0, side, -7}), place({40, side, -7})), 1e-4);
    }
  }
}

TEST(Pencil, ASlotNarrowerThanTheBallHoldsItOnSharpEdgesOnly) {
  const auto slot = [](double half) {
    return both(both(mesh::box_mesh({0, half, -10}, {40, 30, 0}), mesh::box_mesh({0, -30, -10}, {40, -half, 0})),
                mesh::box_mesh({0, -30, -20}, {40, 30, -10}));
  };
  EXPECT_TRUE(pencil(slot(2), 3).paths.empty());
  EXPECT_FALSE(pencil(slot(2), 3).reason.empty());
  EXPECT_GT(pencil(slot(2), 3).rest_area, 900);
  EXPECT_EQ(pencil(slot(4), 3).paths.size(), 2U);
}

TEST(Pencil, ConvexPartsAreDoneWithOneBallForATriangle) {
  for (const Mesh& part :
       {mesh::box_mesh({0, 0, 0}, {50, 40, 30}), subdivided(mesh::box_mesh({0, 0, 0}, {50, 40, 30}), 3),
        mesh::sphere_mesh(20, 4), cylinder_mesh(5, 0, 30, 200)}) {
    const PencilResult result = pencil(part, 3);
    EXPECT_TRUE(result.paths.empty());
    EXPECT_NE(result.reason.find("reaches every point"), std::string::npos);
    EXPECT_LE(result.stats.balls, part.triangles.size());
    EXPECT_EQ(result.stats.starts, 0U);
    EXPECT_EQ(result.rest_area, 0);
  }
}

TEST(Pencil, FarFromValleysNoBallsAreTried) {
  const auto balls = [](double half_length) { return pencil(groove(kPi / 2, half_length), 3).stats.balls; };
  EXPECT_LT(static_cast<double>(balls(160)), 4.6 * static_cast<double>(balls(40)));
  Mesh wide = groove(kPi / 2);
  const std::size_t before = pencil(wide, 3).stats.balls;
  EXPECT_LE(pencil(both(wide, mesh::box_mesh({500, 0, 0}, {900, 400, 300})), 3).stats.balls, before + 12);
}

TEST(Pencil, CracksDoubledAndDegenerateTrianglesChangeNothing) {
  const double z = -8 + 3 * std::sqrt(2.0);
  const Mesh part = subdivided(groove(kPi / 2), 2);
  Mesh spoilt = part;
  for (const Vec3i& t : part.triangles) {  // zero area, needles, doubled walls, in both orientations
    spoilt.triangles.push_back(t), spoilt.triangles.emplace_back(t.x, t.x, t.y),
        spoilt.triangles.emplace_back(t.z, t.z, t.z);
  }
  const int n = static_cast<int>(spoilt.vertices.size());
  spoilt.vertices.push_back(part.vertices[part.triangles[0].x]);
  spoilt.vertices.push_back(part.vertices[part.triangles[0].y]);
  spoilt.vertices.push_back(0.5 * (spoilt.vertices[n] + spoilt.vertices[n + 1]));
  spoilt.triangles.emplace_back(n, n + 1, n + 2);
  for (const Mesh& mesh : {cracked(part, 0), cracked(part, 1e-6), spoilt}) {
    const PencilResult result = pencil(mesh, 3);
    ASSERT_EQ(result.paths.size(), 1U);
    EXPECT_LT(hausdorff(result.paths[0], {0, 0, z}, {40, 0, z}), 1e-4);
  }
}

TEST(Pencil, RoughSheetsGiveBallsThatEnterNothingWithTheSameBytesOnAnyThreads) {
  const Mesh part = mesh::sheet_mesh(30, 30, [](double x, double y) {
    return 2 * std::sin(0.31 * x + 0.2 * y) * std::cos(0.27 * y - 0.1 * x) + 3 * std::abs(std::sin(0.15 * x));
  });
  std::vector<PencilResult> results;
  for (const char* threads : {"1", "2", "5"}) {
    if (test::kSanitized && *threads == '2') continue;
    setenv("RIFFLER_THREADS", threads, 1);
    results.push_back(pencil(part, 4, {.tolerance = 0.02}));
  }
  unsetenv("RIFFLER_THREADS");
  ASSERT_FALSE(results[0].paths.empty());
  for (const PencilPath& path : results[0].paths) expect_rolls(part, path, 0.4);
  for (const PencilResult& other : results) {
    ASSERT_EQ(other.paths.size(), results[0].paths.size());
    for (std::size_t i = 0; i < other.paths.size(); ++i) {
      EXPECT_EQ(other.paths[i].centres, results[0].paths[i].centres);
      EXPECT_EQ(other.paths[i].contacts, results[0].paths[i].contacts);
      EXPECT_EQ(other.paths[i].normals, results[0].paths[i].normals);
    }
    EXPECT_EQ(other.rest_areas, results[0].rest_areas);
  }
}

TEST(Pencil, WrongCallsAreRefusedAndCancelledOnesStop) {
  const Mesh part = groove(kPi / 2);
  EXPECT_THROW(pencil({}, 3), std::invalid_argument);
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(pencil(part, bad), std::invalid_argument);
    EXPECT_THROW(pencil(part, 3, {.tolerance = bad}), std::invalid_argument);
  }
  EXPECT_THROW(pencil(part, 3, {.bitangency_angle = 4.0}), std::invalid_argument);
  EXPECT_THROW(pencil(part, 3, {.minimum_length = -1}), std::invalid_argument);
  EXPECT_TRUE(pencil(part, 3, {.minimum_length = 41}).paths.empty());
  EXPECT_THROW(pencil(part, 3, {}, [](double share) { return share < 0.5; }), Cancelled);
  double last = 0;
  pencil(part, 3, {}, [&](double share) { return last = share, true; });
  EXPECT_EQ(last, 1);
}

TEST(Pencil, SearchesWithBallsOfManySizesEnd) {
  const Mesh part = groove(kPi / 2);
  for (const double radius : {1e-2, 0.3, 10.0, 1e3}) {
    const PencilResult result = pencil(part, radius, {.tolerance = 0.01});
    // The gap of the smallest one is within the tolerance, the contacts of the largest are beyond the walls.
    EXPECT_EQ(result.paths.size(), radius > 0.1 && radius < 11 ? 1U : 0U) << radius << " " << result.reason;
    EXPECT_EQ(result.stats.cut, 0U);
  }
}

TEST(Pencil, AnAbsurdBallForThePartIsRefused) {
  const Mesh part = groove(1.5);
  EXPECT_THROW(pencil(part, 1e6, {.tolerance = 0.01}), std::invalid_argument);
  EXPECT_THROW(pencil(part, 5e5, {.tolerance = 0.01, .passes = 2}), std::invalid_argument);
  EXPECT_THROW(pencil(part, 1e-7, {.tolerance = 0.01}), std::invalid_argument);
  EXPECT_THROW(pencil(part, 3, {.tolerance = 1e-9}), std::invalid_argument);
  EXPECT_THROW(pencil(part, 3, {.tolerance = 0.01, .stepover = 1e300}), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::plan::pencil_test
