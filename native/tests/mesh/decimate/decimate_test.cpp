#include "riffler/mesh/decimate/decimate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>
#include <set>

#include "bench/mesh_distance.hpp"
#include "geom/float32.hpp"
#include "mesh/io/stl.hpp"
#include "mesh/shapes.hpp"
#include "riffler/mesh/audit.hpp"
#include "support/effort.hpp"

namespace riffler::mesh::decimate_test {
namespace {

/// Largest distance of points of `from`, dense on each of its triangles, from `to`, by a search that shares no code
/// with what is tested.
double one_way(const Mesh& from, const Mesh& to) {
  std::vector<Vec3> points;
  for (const Vec3i& t : from.triangles) {
    const Vec3 &a = from.vertices[t.x], &b = from.vertices[t.y], &c = from.vertices[t.z];
    const double longest = std::max({glm::length(b - a), glm::length(c - b), glm::length(a - c)});
    const int n = std::clamp(static_cast<int>(longest / 0.2) + 1, 2, 40);
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j)
        points.push_back((a * (n - i - j * 1.0) + b * (i * 1.0) + c * (j * 1.0)) / (n * 1.0));
  }
  return bench::MeshDistance(to).farthest(points);
}

void expect_sound(const Mesh& mesh) {
  for (const Mesh& m : {mesh, from_stl(to_stl(mesh), "part")}) {
    const Audit a = audit(m);
    EXPECT_TRUE(a.watertight());
    EXPECT_EQ(a.degenerate + a.duplicates + a.folds, 0U);
    EXPECT_EQ(m.vertices.size(), mesh.vertices.size());  // welding joined none
  }
}

Mesh rough(Mesh mesh, double height) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> step(-height, height);
  for (Vec3& v : mesh.vertices) v += Vec3(step(random), step(random), step(random));
  return mesh;
}

TEST(Decimate, StaysWithinTheToleranceInBothDirections) {
  struct Case {
    Mesh mesh;
    std::size_t most;  // triangles left at a tolerance of 0.05
  };
  const auto wave = [](double x, double y) { return std::sin(x) * std::cos(1.3 * y); };
  const Case cases[] = {{sphere_mesh(10, 5), 2000},
                        {torus_mesh(10, 4, 120, 60), 2500},
                        {rough(torus_mesh(10, 4, 120, 60), 0.02), 8000},
                        {rough(subdivided(box_mesh({0, 0, 0}, {10, 8, 6}), 4), 0.03), 1500},
                        {sheet_mesh(60, 12, wave), 3000}};
  for (const Case& c : cases) {
    const bool closed = audit(c.mesh).watertight() && audit(c.mesh).open_edges == 0;
    std::size_t before = c.mesh.triangles.size();
    for (const double tolerance : {0.002, 0.05, 0.5}) {
      if (test::kSanitized && tolerance != 0.05) continue;
      const Mesh result = decimate(c.mesh, {{}, tolerance});
      EXPECT_LE(one_way(c.mesh, result), tolerance);
      EXPECT_LE(one_way(result, c.mesh), tolerance);
      EXPECT_LE(result.triangles.size(), before);
      before = result.triangles.size();
      if (tolerance == 0.05) {
        EXPECT_LT(result.triangles.size(), c.most);
      }
      if (closed) expect_sound(result);
    }
  }
}

/// A sphere or a torus with waves, and with noise: on every vertex, along the radius, or as spikes here and there.
Mesh bumpy(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  const auto any = [&] { return part(random); };
  const int times = 4 + static_cast<int>(2 * any());
  Mesh mesh = sphere_mesh(10, times);
  if (any() < 0.3) {
    const int around = static_cast<int>(60 + 80 * any());
    mesh = torus_mesh(10, 4, around, static_cast<int>(30 + 50 * any()));
  }
  const double noise = std::pow(10, -3 + 3 * any());
  const int waves = static_cast<int>(6 * any());
  for (int k = 0; k < waves; ++k) {
    const double x = any(), y = any(), z = any(), length = std::pow(10, -0.5 + 1.2 * any()), phase = 6.28 * any();
    const double height = any(), share = 0.3 * height * std::pow(10, -1.5 + 1.5 * any());
    const Vec3 wave = length * Vec3(x - 0.5, y - 0.5, z - 0.5);
    for (Vec3& v : mesh.vertices) v *= 1 + share * std::sin(glm::dot(wave, v) + phase);
  }
  const int kind = static_cast<int>(3 * any());
  for (Vec3& v : mesh.vertices) {
    if (kind == 0) {
      const double x = any(), y = any(), z = any();
      v += noise * Vec3(x - 0.5, y - 0.5, z - 0.5);
    } else if (kind == 1) {
      v *= 1 + 0.1 * noise * (any() - 0.5);
    } else if (any() < 0.05) {
      v *= 1 + 0.3 * noise;
    }
  }
  return mesh;
}

TEST(Decimate, RandomBumpsStayWithinTheTolerance) {
  struct Case {
    unsigned seed;
    double tolerance;
  };
  // What the checks of the single collapses let pass by themselves: 1.06 times the tolerance from old to new for the
  // first, 1.02 times from new to old for the second.
  for (const Case& c : {Case{6, 0.1}, Case{66, 0.3}, Case{1, 0.05}, Case{2, 0.3}}) {
    if (test::kSanitized && c.seed < 6) continue;
    const Mesh mesh = bumpy(c.seed), result = decimate(mesh, {{}, c.tolerance});
    EXPECT_LT(result.triangles.size(), mesh.triangles.size()) << "seed " << c.seed;
    EXPECT_LE(one_way(mesh, result), c.tolerance) << "seed " << c.seed;
    EXPECT_LE(one_way(result, mesh), c.tolerance) << "seed " << c.seed;
  }
}

TEST(Decimate, ABoxBecomesTwelveTriangles) {
  const Mesh mesh = subdivided(box_mesh({1, 2, 3}, {41, 33, 27}), 5);
  const Mesh result = decimate(mesh, {{}, 1e-6});
  EXPECT_EQ(result.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(volume(result), 40.0 * 31 * 24);
  expect_sound(result);
}

TEST(Decimate, ABoxFarAwayBecomesTwelveTriangles) {
  const Mesh mesh = subdivided(box_mesh({1e5, 2e5, -1e5}, {100040, 200032, -99976}), 4);
  const Mesh result = decimate(mesh, {{}, 1e-3});
  EXPECT_EQ(result.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(volume(result), 40.0 * 32 * 24);
}

TEST(Decimate, ABoxTurnedAtRandomKeepsItsEdges) {
  const Vec3 x = glm::normalize(Vec3(1, 2, 3)), y = glm::normalize(glm::cross(x, Vec3(0.3, -1, 2)));
  const Mat3 turn(x, y, glm::cross(x, y));
  Mesh mesh = subdivided(box_mesh({0, 0, 0}, {40, 31, 24}), 4);
  for (Vec3& v : mesh.vertices) v = geom::to_float32(turn * v);
  const Mesh result = decimate(mesh, {{}, 0.001});
  EXPECT_EQ(result.triangles.size(), 12U);
  EXPECT_LE(one_way(mesh, result), 0.001);
  EXPECT_LE(one_way(result, mesh), 0.001);
}

TEST(Decimate, ReachesACount) {
  const Mesh mesh = sphere_mesh(10, 5);
  for (const std::size_t n : {4000, 1000, 100}) {
    const Mesh result = decimate(mesh, {n, {}});
    EXPECT_LE(result.triangles.size(), n);
    EXPECT_GE(result.triangles.size(), n - 1);
    expect_sound(result);
    // An inscribed sphere of n even triangles misses 4 π / √3 n of the radius (its triangles' centres); quadrics place
    // them about evenly.
    EXPECT_LT(one_way(mesh, result), 3 * 10 * 7.26 / static_cast<double>(n));
  }
}

TEST(Decimate, StopsAtTheFirstLimit) {
  const Mesh mesh = sphere_mesh(10, 4);
  EXPECT_EQ(decimate(mesh, {1500, 0.5}).triangles.size(), 1500U);
  const Mesh result = decimate(mesh, {4, 0.1});
  EXPECT_GT(result.triangles.size(), 100U);
  EXPECT_LE(one_way(mesh, result), 0.1);
}

TEST(Decimate, SmallestBodiesStayBodies) {
  for (const Mesh& mesh : {sphere_mesh(1, 0), box_mesh({0, 0, 0}, {1, 1, 1}), sphere_mesh(1, 3)}) {
    const Mesh result = decimate(mesh, {0, {}});
    expect_sound(result);
    EXPECT_GE(result.triangles.size(), 4U);
    EXPECT_GT(volume(result), 0);
  }
}

TEST(Decimate, EveryComponentStays) {
  const Mesh small = sphere_mesh(0.5, 3);
  const Mesh mesh = both(sphere_mesh(10, 4), moved(small, {30, 0, 0}));
  const Mesh result = decimate(mesh, {{}, 0.2});
  EXPECT_EQ(audit(result).components, 2U);
  EXPECT_LE(one_way(mesh, result), 0.2);
}

TEST(Decimate, VerticesThatMovedAreFloat32) {
  const Mesh mesh = sphere_mesh(10.0 / 3, 4);
  std::set<std::array<double, 3>> old;
  for (const Vec3& v : mesh.vertices) old.insert({v.x, v.y, v.z});
  int moved = 0;
  for (const Vec3& v : decimate(mesh, {300, {}}).vertices) {
    if (old.contains({v.x, v.y, v.z})) continue;
    EXPECT_EQ(v, geom::to_float32(v));
    ++moved;
  }
  EXPECT_GT(moved, 100);
}

TEST(Decimate, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = rough(torus_mesh(10, 4, 260, 130), 0.01);  // several patches, several partitions
  const auto run = [&](const char* threads) {
    setenv("RIFFLER_THREADS", threads, 1);
    std::vector<Mesh> results{decimate(mesh, {6000, {}}), decimate(mesh, {{}, 0.05})};
    if (!test::kSanitized) results.push_back(decimate(mesh, {6000, 0.05}));
    unsetenv("RIFFLER_THREADS");
    return results;
  };
  const std::vector<Mesh> one = run("1");
  EXPECT_EQ(one[0].triangles.size(), 6000U);
  for (const Mesh& result : one) expect_sound(result);
  for (const char* threads : {"2", "7"}) {
    if (test::kSanitized && *threads == '2') continue;
    const std::vector<Mesh> more = run(threads);
    for (std::size_t i = 0; i < one.size(); ++i) {
      EXPECT_EQ(one[i].vertices, more[i].vertices);
      EXPECT_EQ(one[i].triangles, more[i].triangles);
    }
  }
}

TEST(Decimate, NewVerticesStraddleTheSurface) {
  // The vertices of an inscribed mesh lie on the sphere and its triangles within; the best ones straddle it.
  const Mesh mesh = sphere_mesh(10, 6);
  const Mesh result = decimate(mesh, {2000, {}});
  const double inscribed = 10 * 7.26 / 2000;  // 4 π / √3 n of the radius
  EXPECT_LT(one_way(mesh, result), inscribed);
  EXPECT_LT(one_way(result, mesh), inscribed);
  EXPECT_NEAR(volume(result) / volume(mesh), 1, 0.003);  // 0.5 % for an inscribed one
}

TEST(Decimate, VerticesStayDistinctInFloat32) {
  // Float32 has steps of 1 out there: two spheres that cross have vertices that would be one.
  const Vec3 far(1.6e7);
  int movable = 0;
  for (int turn = 0; turn < 200; ++turn) {
    Mesh second = sphere_mesh(100, 3);
    const double c = std::cos(0.1 + 0.03 * turn), s = std::sin(0.1 + 0.03 * turn);
    for (Vec3& v : second.vertices) v = Vec3(c * v.x - s * v.y + 2, s * v.x + c * v.y + 3, v.z + 4);
    Mesh mesh = both(moved(sphere_mesh(100, 3), far), moved(second, far));
    for (Vec3& v : mesh.vertices) v = geom::to_float32(v);
    if (from_stl(to_stl(mesh), "part").vertices.size() < mesh.vertices.size()) continue;
    ++movable;
    expect_sound(decimate(mesh, {600, {}}));
  }
  EXPECT_GT(movable, 50);
}

TEST(Decimate, ABorderKeepsToTheTolerance) {
  const Mesh mesh = sheet_mesh(40, 10, [](double x, double y) { return 0.1 * std::sin(2 * x) + 0.05 * y; });
  const Mesh result = decimate(mesh, {{}, 0.02});
  EXPECT_LT(result.triangles.size(), mesh.triangles.size() / 4);
  const Audit a = audit(result);
  EXPECT_EQ(a.nonmanifold_edges + a.nonmanifold_vertices, 0U);
  EXPECT_EQ(a.components, 1U);
  const Box3 box = bounds(result);
  EXPECT_EQ(Vec2(box.lower.x, box.lower.y), Vec2(0));
  EXPECT_EQ(Vec2(box.upper.x, box.upper.y), Vec2(10));
}

TEST(Decimate, NonManifoldInputIsNotMadeWorse) {
  const Mesh one = subdivided(box_mesh({0, 0, 0}, {4, 4, 4}), 3);
  const Mesh mesh = from_stl(to_stl(both(one, moved(one, {4, 4, 0}))), "part");  // they touch along an edge
  const Audit before = audit(mesh);
  ASSERT_EQ(before.nonmanifold_edges, 8U);
  const Mesh result = decimate(mesh, {{}, 0.01});
  const Audit after = audit(result);
  EXPECT_EQ(after.nonmanifold_edges, 8U);  // the ends of such edges stay
  EXPECT_EQ(after.open_edges, 0U);
  EXPECT_LT(result.triangles.size(), mesh.triangles.size() / 4);
  EXPECT_DOUBLE_EQ(after.volume, 128);
}

TEST(Decimate, SurvivesEmptyAndDegenerateMeshes) {
  EXPECT_TRUE(decimate({}, {10, {}}).empty());
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(decimate(mesh, {12, {}}).triangles, mesh.triangles);
  mesh.triangles.emplace_back(0, 0, 1), mesh.triangles.push_back(mesh.triangles[0]);
  EXPECT_NO_THROW(audit(decimate(mesh, {{}, 0.1})));
  EXPECT_NO_THROW(audit(decimate(mesh, {4, {}})));
  Mesh lone;
  lone.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  lone.triangles = {{0, 1, 2}};
  EXPECT_EQ(decimate(lone, {0, 10.0}).triangles.size(), 1U);
}

TEST(Decimate, RefusesBadLimits) {
  const Mesh mesh = sphere_mesh(1, 1);
  EXPECT_THROW(decimate(mesh, {}), std::invalid_argument);
  EXPECT_THROW(decimate(mesh, {{}, -1.0}), std::invalid_argument);
  EXPECT_THROW(decimate(mesh, {{}, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(decimate(mesh, {{}, std::numeric_limits<double>::infinity()}), std::invalid_argument);
}

TEST(Decimate, CanBeCancelled) {
  EXPECT_THROW(decimate(sphere_mesh(10, 5), {100, {}}, [](double share) { return share < 0.5; }), Cancelled);
  EXPECT_THROW(decimate(sphere_mesh(10, 5), {{}, 0.1}, [](double share) { return share < 0.8; }), Cancelled);
}

TEST(Decimate, ProgressNeverGoesBack) {
  for (const unsigned seed : {6U, 1U}) {
    double last = 0;
    decimate(bumpy(seed), {{}, 0.1}, [&](double share) {
      EXPECT_GE(share, last);
      EXPECT_LE(share, 1);
      last = share;
      return true;
    });
    EXPECT_GT(last, 0.85);
  }
}

/// Bounds on the proof's pieces, where a depth of halving is none: these took minutes and gigabytes.
TEST(Decimate, AToleranceNearZeroEndsSoon) {
  const auto start = std::chrono::steady_clock::now();
  const Mesh block = subdivided(box_mesh({0.1, 0.2, 0.3}, {20.4, 14.7, 10.9}), 3);
  int told = 0;
  for (const double tolerance : {0.0, 1e-12, 1e-5, 2e-5}) {
    const Mesh result = decimate(block, {.triangles = {}, .tolerance = tolerance}, [&](double) { return ++told > 0; });
    EXPECT_LE(result.triangles.size(), block.triangles.size());
    EXPECT_LE(std::max(one_way(result, block), one_way(block, result)), tolerance + 2e-6);
  }
  EXPECT_GT(told, 20);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

/// All triangles round one vertex, below a disk's edge or above and below it: what a collapse looks at grew with all of
/// them.
TEST(Decimate, FansOfManyTrianglesTakeTimeByTheTriangle) {
  constexpr int kMany = test::cases(50'000);
  for (const bool open : {false, true}) {
    Mesh fan;
    fan.vertices = {{0, 0, 30}, {0, 0, -30}};
    for (int k = 0; k < kMany; ++k) {
      const double angle = 2 * std::acos(-1.0) * k / kMany;
      fan.vertices.emplace_back(100 * std::cos(angle), 100 * std::sin(angle), 0);
    }
    for (int k = 0; k < kMany; ++k) {
      const int a = 2 + k, b = 2 + (k + 1) % kMany;
      fan.triangles.emplace_back(0, a, b);
      if (!open) fan.triangles.emplace_back(1, b, a);
    }
    const auto start = std::chrono::steady_clock::now();
    EXPECT_LE(decimate(fan, {.triangles = 2000, .tolerance = {}}).triangles.size(), 2100U);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
  }
}

}  // namespace
}  // namespace riffler::mesh::decimate_test
