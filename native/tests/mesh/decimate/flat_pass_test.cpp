// What goes from planes, what stays, and how far anything moves.
#include "mesh/decimate/flat_pass.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "bench/mesh_distance.hpp"
#include "bench/scenes.hpp"
#include "mesh/shapes.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/audit.hpp"
#include "riffler/mesh/decimate/decimate.hpp"
#include "riffler/sweep/carve.hpp"
#include "support/effort.hpp"

namespace riffler::mesh::flat_pass_test {
namespace {

/// Largest distance of vertices and triangles' centres of `from` from `to`, by a search that shares no code with what
/// is tested.
double one_way(const Mesh& from, const Mesh& to) {
  std::vector<Vec3> points(from.vertices.begin(), from.vertices.end());
  for (const Vec3i& t : from.triangles)
    for (const Vec3& w : {Vec3(0.34, 0.33, 0.33), Vec3(0.5, 0.5, 0), Vec3(0, 0.5, 0.5), Vec3(0.9, 0.05, 0.05)})
      points.push_back(w.x * from.vertices[t.x] + w.y * from.vertices[t.y] + w.z * from.vertices[t.z]);
  return bench::MeshDistance(to).farthest(points);
}

Mesh flat_sheet(int n) {
  return sheet_mesh(n, 10, [](double, double) { return 0.0; });
}

TEST(FlatPass, LeavesMeshesWithoutPlanesUnchanged) {
  Mesh lone;
  lone.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  lone.triangles = {{0, 1, 2}};
  for (const Mesh& mesh : {Mesh{}, lone, box_mesh({0, 0, 0}, {1, 2, 3}), sphere_mesh(10, 3)}) {
    Mesh left = mesh;
    const FlatPass pass = remove_inside_planes(left, 1e-6, 0);
    EXPECT_EQ(left.vertices, mesh.vertices);
    EXPECT_EQ(left.triangles, mesh.triangles);
    EXPECT_EQ(pass.source.size(), mesh.vertices.size());
    EXPECT_EQ(pass.moved, 0);
  }
}

TEST(FlatPass, LeavesDegenerateTrianglesUnchanged) {
  Mesh mesh = flat_sheet(6);
  const std::size_t vertices = mesh.vertices.size();
  mesh.vertices.emplace_back(100, 0, 0);         // without triangles: goes
  mesh.triangles.emplace_back(24, 24, 25);       // names a vertex twice: blocks that vertex
  mesh.triangles.push_back(mesh.triangles[40]);  // twice the same
  const Vec3i odd = mesh.triangles[40];
  const FlatPass pass = remove_inside_planes(mesh, 0, 0);
  EXPECT_LT(mesh.vertices.size(), vertices);
  const auto has = [&](int v) { return std::count(pass.source.begin(), pass.source.end(), v); };
  EXPECT_EQ(has(24), 1);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(has(odd[k]), 1);
  EXPECT_EQ(has(static_cast<int>(vertices)), 0);
}

TEST(FlatPass, ASheetKeepsItsBorderAndItsArea) {
  const Mesh mesh = flat_sheet(200);
  Mesh left = mesh;
  const FlatPass pass = remove_inside_planes(left, 0, 0);
  EXPECT_LT(left.triangles.size(), 1500U);  // the border's 800 vertices need 798
  EXPECT_EQ(pass.moved, 0);
  EXPECT_NEAR(area(left), 100, 1e-9);
  const Audit a = audit(left);
  EXPECT_EQ(a.nonmanifold_edges + a.nonmanifold_vertices + a.folds + a.degenerate, 0U);
  EXPECT_EQ(a.open_edges, 800U);
  for (std::size_t v = 0; v < left.vertices.size(); ++v) EXPECT_EQ(left.vertices[v], mesh.vertices[pass.source[v]]);
}

/// Two sheets back to back, with one border: an edge across one of them may exist on the other.
TEST(FlatPass, APlateWithoutThicknessStaysTwoManifold) {
  for (const int n : {1, 2, 3, 4, 5, 8, 30}) {
    Mesh mesh = flat_sheet(n);
    const std::size_t sheet = mesh.triangles.size();
    std::vector<int> other(mesh.vertices.size());
    for (std::size_t v = 0, before = other.size(); v < before; ++v) {
      const Vec3 p = mesh.vertices[v];
      const bool border = std::min(p.x, p.y) == 0 || std::max(p.x, p.y) > 10 - 1e-9;
      other[v] = border ? static_cast<int>(v) : static_cast<int>(mesh.vertices.size());
      if (!border) mesh.vertices.push_back(p);
    }
    for (std::size_t t = 0; t < sheet; ++t) {
      const Vec3i c = mesh.triangles[t];
      mesh.triangles.emplace_back(other[c.x], other[c.z], other[c.y]);
    }
    const Audit before = audit(mesh);
    remove_inside_planes(mesh, 1e-9, 0);
    const Audit after = audit(mesh);
    EXPECT_EQ(after.nonmanifold_edges, before.nonmanifold_edges) << n;
    EXPECT_EQ(after.nonmanifold_vertices, before.nonmanifold_vertices) << n;
    EXPECT_EQ(after.open_edges, 0U) << n;
    EXPECT_LE(after.duplicates, before.duplicates) << n;
    EXPECT_NEAR(area(mesh), 200, 1e-9) << n;
  }
}

/// Boxes turned at random, rough by about the slack: nothing moves farther than the pass says.
TEST(FlatPass, RoughPlanesMoveByNoMoreThanTheReportedDistance) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> part(-1, 1);
  std::size_t gone = 0;
  for (int k = 0; k < (test::kSanitized ? 6 : 40); ++k) {
    Mesh mesh = subdivided(box_mesh({0, 0, 0}, {10, 8, 6}), 4);
    const Vec3 x = glm::normalize(Vec3(part(random), part(random), part(random) + 2));
    const Vec3 y = glm::normalize(glm::cross(x, Vec3(part(random), 2, part(random))));
    const double noise = std::pow(10, -5 + 3 * std::abs(part(random))), slack = 1e-3;
    for (Vec3& v : mesh.vertices)
      v = Mat3(x, y, glm::cross(x, y)) * v + noise * Vec3(part(random), part(random), part(random));
    Mesh left = mesh;
    const FlatPass pass = remove_inside_planes(left, slack, 0);
    gone += mesh.vertices.size() - left.vertices.size();
    EXPECT_LE(pass.moved, kFlatTurns * 2 * std::sqrt(3.0) * slack);
    EXPECT_LE(one_way(mesh, left), pass.moved + 1e-12) << k;
    EXPECT_LE(one_way(left, mesh), pass.moved + 1e-12) << k;
    const Audit a = audit(left);
    EXPECT_TRUE(a.watertight()) << k;
    EXPECT_EQ(a.folds + a.degenerate + a.duplicates, 0U) << k;
  }
  EXPECT_GT(gone, 1000U);
}

Mesh carved(double pitch) {
  const bench::NamedCutter ball = bench::named_cutters().front();
  Volume volume = Volume::block({{Vec3(0.0), bench::kBlock}, pitch, "xyz"});
  sweep::carve(volume, ball.tool, bench::path(ball.centre_height, false), {});
  return marching::to_mesh(volume);
}

TEST(FlatPass, ACarvedBlockIsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = carved(test::kSanitized ? 1 : 0.4);
  Mesh results[3];
  for (int k = 0; k < 3; ++k) {
    setenv("RIFFLER_THREADS", k == 0 ? "1" : k == 1 ? "2" : "4", 1);
    results[k] = mesh;
    const FlatPass pass = remove_inside_planes(results[k], 1e-6, 0);
    unsetenv("RIFFLER_THREADS");
    EXPECT_LE(pass.moved, kFlatTurns * 2 * std::sqrt(3.0) * 1e-6);
    EXPECT_EQ(results[k].vertices, results[0].vertices);
    EXPECT_EQ(results[k].triangles, results[0].triangles);
  }
  if (!test::kSanitized) {
    EXPECT_LT(results[0].triangles.size(), mesh.triangles.size() / 4);
  }
  EXPECT_TRUE(audit(results[0]).watertight());
  EXPECT_NEAR(volume(results[0]), volume(mesh), 1e-6);
}

TEST(FlatPass, CurvesMoveByNoMoreThanTheReportedDistance) {
  Mesh egg = sphere_mesh(10, test::kSanitized ? 5 : 7);  // several bricks, from 16 384 triangles on
  for (Vec3& v : egg.vertices) v *= Vec3(1, 1.2, 1.5 + 0.02 * v.z);
  for (const Mesh& mesh : {egg, carved(test::kSanitized ? 1 : 0.4)})
    for (const double curved : {1e-4, 1e-3, 1e-2, 1.0, 100.0}) {
      Mesh results[2];
      for (int k = 0; k < 2; ++k) {
        setenv("RIFFLER_THREADS", k == 0 ? "1" : "3", 1);
        results[k] = mesh;
        const FlatPass pass = remove_inside_planes(results[k], 1e-6, curved);
        unsetenv("RIFFLER_THREADS");
        EXPECT_LE(pass.moved, curved + kFlatTurns * 2 * std::sqrt(3.0) * 1e-6);
        if (k == 0) {
          EXPECT_LE(one_way(mesh, results[k]), pass.moved + 1e-9) << curved;
          EXPECT_LE(one_way(results[k], mesh), pass.moved + 1e-9) << curved;
        }
      }
      EXPECT_EQ(results[0].vertices, results[1].vertices);
      EXPECT_EQ(results[0].triangles, results[1].triangles);
      const Audit a = audit(results[0]);
      EXPECT_TRUE(a.watertight()) << curved;
      EXPECT_EQ(a.folds + a.degenerate + a.duplicates, 0U) << curved;
      if (curved >= (test::kSanitized ? 1 : 1e-2)) {  // the sanitized meshes are coarser
        EXPECT_LT(results[0].triangles.size(), mesh.triangles.size() / 2) << curved;
      }
    }
}

TEST(FlatPass, AFanThatWindsTwiceStays) {
  // Ten triangles around a branch point: two turns, all facing up, which no plane holds.
  Mesh mesh;
  constexpr int kSides = 10;
  mesh.vertices.emplace_back(0, 0, 0);
  for (const double radius : {1.0, 2.0})
    for (int k = 0; k < kSides; ++k) {
      const double turn = 4 * std::acos(-1.0) * k / kSides;
      mesh.vertices.emplace_back(radius * std::cos(turn), radius * std::sin(turn), 1e-3 * k * (kSides - k));
    }
  for (int k = 0; k < kSides; ++k) {
    const int a = 1 + k, b = 1 + (k + 1) % kSides;
    mesh.triangles.emplace_back(0, a, b);
    mesh.triangles.emplace_back(a, a + kSides, b), mesh.triangles.emplace_back(b, a + kSides, b + kSides);
  }
  Mesh left = mesh;
  const FlatPass pass = remove_inside_planes(left, 1e-9, 0.5);
  EXPECT_TRUE(std::count(pass.source.begin(), pass.source.end(), 0)) << "the branch point is gone";
}

/// The map between the surfaces has holes in flats next to curves; those made whole flats count as far, and 231 892
/// triangles stay after nine attempts.
TEST(Decimate, FlatsBesideCurvesAreProvenAtOnce) {
  if (test::kSanitized) GTEST_SKIP() << "takes minutes there";
  const Mesh mesh = carved(0.4);
  double last = 0;
  const Mesh result = decimate(mesh, {{}, 0.005}, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
    return true;
  });
  EXPECT_LT(result.triangles.size(), 16'000U);
  EXPECT_TRUE(audit(result).watertight());
  EXPECT_LE(one_way(mesh, result), 0.005);
  EXPECT_LE(one_way(result, mesh), 0.005);
}

/// How long a cancelled call continues, as triangles for each report: no time, which depends on the machine.
TEST(Decimate, ReportsAfterAFewThousandTriangles) {
  const Mesh mesh = carved(test::kSanitized ? 1 : 0.4);
  setenv("RIFFLER_THREADS", "1", 1);
  std::size_t told = 0, most = 0;
  decimate(mesh, {{}, 0.01}, [&](double) { return ++told > 0; });
  EXPECT_GT(told, mesh.triangles.size() / 2000);
  for (const double share : {0.0, 0.01, 0.1, 0.15, 0.3, 0.7, 0.8, 0.9}) {
    if (test::kSanitized && share != 0.01 && share != 0.15 && share != 0.7) continue;
    std::size_t after = 0;
    EXPECT_THROW(decimate(mesh, {{}, 0.01},
                          [&](double now) {
                            after += now > share ? 1 : 0;
                            return now <= share;
                          }),
                 Cancelled);
    most = std::max(most, after);
  }
  unsetenv("RIFFLER_THREADS");
  EXPECT_EQ(most, 1U);  // the first refusal ends the call
}

}  // namespace
}  // namespace riffler::mesh::flat_pass_test
