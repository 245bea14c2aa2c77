#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/closest.hpp"
#include "nurbs/quadrics.hpp"
#include "riffler/mesh/audit.hpp"
#include "riffler/nurbs/surface.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::nurbs::to_mesh_test {
namespace {

using test::error_of;

void expect_closed(const Mesh& mesh, const char* name) {
  const mesh::Audit a = audit(mesh);
  EXPECT_EQ(a.open_edges, 0U) << name;
  EXPECT_EQ(a.nonmanifold_edges, 0U) << name;
  EXPECT_EQ(a.nonmanifold_vertices, 0U) << name;
  EXPECT_EQ(a.degenerate, 0U) << name;
  EXPECT_EQ(a.components, 1U) << name;
}

/// Points of triangles: corners, middles of edges, centres.
std::vector<Vec3> points_of(const Mesh& mesh) {
  std::vector<Vec3> points(mesh.vertices.begin(), mesh.vertices.end());
  for (const Vec3i& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t.x], b = mesh.vertices[t.y], c = mesh.vertices[t.z];
    points.insert(points.end(), {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0});
  }
  return points;
}

TEST(SurfaceToMesh, IsClosedAndWithinToleranceOfBallsAndTori) {
  for (const Vec3& offset : {Vec3(0), Vec3(1e5, 1e5, -1e5)})
    for (const double tolerance : {0.5, 0.1, 0.01}) {
      const Mesh ball = Surface({shapes::ball(10, 4, offset)}).to_mesh(tolerance);
      expect_closed(ball, "ball");
      double error = 0;
      for (const Vec3& p : points_of(ball)) error = std::max(error, std::abs(glm::length(p - offset) - 10));
      EXPECT_LE(error, tolerance);
      EXPECT_GE(error, 0.25 * tolerance);  // not many more triangles than the tolerance needs
      EXPECT_GT(volume(ball), 0);
      const Mesh ring = Surface({shapes::torus(10, 3, offset)}).to_mesh(tolerance);
      expect_closed(ring, "torus");
      error = 0;
      for (const Vec3& q : points_of(ring)) {
        const Vec3 p = q - offset;
        error = std::max(error, std::abs(std::hypot(std::hypot(p.x, p.y) - 10, p.z) - 3));
      }
      EXPECT_LE(error, tolerance);
      EXPECT_GE(error, 0.25 * tolerance);
    }
}

TEST(SurfaceToMesh, HasAboutAsManyTrianglesAsAChordNeeds) {
  // A cylinder needs n chords of sagitta r (1 - cos(pi / n)), and two triangles for each. A ball cannot do with fewer
  // than its area divided by that of equilateral triangles of the sagitta t: 3 sqrt(3) / 4 · 2 r t. Its parameters are
  // denser at the poles, and the bound counts what second derivatives have along the surface.
  const double r = 10;
  for (const double t : {0.1, 0.01, 0.001, 1e-5}) {
    const double chords = kPi / std::acos(1 - t / r);
    const Mesh cylinder = Surface({shapes::turned(shapes::line({r, 0}, {r, 30}))}).to_mesh(t);
    EXPECT_GE(static_cast<double>(cylinder.triangles.size()), 2 * chords);
    EXPECT_LE(static_cast<double>(cylinder.triangles.size()), 2 * 1.45 * chords);
    if (t < 1e-3) continue;
    const double least = 4 * kPi * r * r / (3 * std::sqrt(3.0) / 4 * 2 * r * t);
    const Mesh ball = Surface({shapes::ball(r)}).to_mesh(t);
    EXPECT_LE(static_cast<double>(ball.triangles.size()), 4.5 * least);
  }
}

TEST(SurfaceToMesh, JoinsPatchesThatShareAnEdgeInAnyDirection) {
  // A ball of four quarters, one of them with u and v exchanged and u reversed; a can of a wall and two lids.
  std::vector<Patch> patches;
  for (int k = 0; k < 4; ++k) {
    Patch quarter = shapes::ball(10, 1);
    for (Vec3& p : quarter.points)
      for (int turn = 0; turn < k; ++turn) p = Vec3(-p.y, p.x, p.z);
    patches.push_back(quarter);
  }
  Patch turned = patches[2];
  std::swap(turned.count_u, turned.count_v);
  std::swap(turned.degree_u, turned.degree_v);
  std::swap(turned.knots_u, turned.knots_v);
  for (std::size_t i = 0; i < turned.count_u; ++i)
    for (std::size_t j = 0; j < turned.count_v; ++j) {
      const std::size_t from = (patches[2].count_u - 1 - j) * patches[2].count_v + i;
      turned.points[i * turned.count_v + j] = patches[2].points[from];
      turned.weights[i * turned.count_v + j] = patches[2].weights[from];
    }
  patches[2] = turned;
  for (const double tolerance : {1.0, 0.1, 0.003}) expect_closed(Surface(patches).to_mesh(tolerance), "quarters");
  const Surface can({shapes::turned(shapes::line({10, 0}, {10, 5})), shapes::turned(shapes::line({0, 0}, {10, 0})),
                     shapes::turned(shapes::line({10, 5}, {0, 5}))});
  for (const double tolerance : {3.0, 0.1, 0.001}) {
    const Mesh mesh = can.to_mesh(tolerance);
    expect_closed(mesh, "can");
    EXPECT_NEAR(volume(mesh), kPi * 500, 200 * tolerance);
  }
}

TEST(SurfaceToMesh, IsWithinToleranceOfRandomPatchesInBothDirections) {
  std::mt19937 random(7);
  for (const double weights : {1.0, 10.0, 1e3})
    for (int k = 0; k < test::cases(6, 2); ++k) {
      const Patch patch = shapes::random_patch(random, 1 + k % 4, 1 + k % 3, weights);
      const Surface surface({patch});
      const double tolerance = k % 2 ? 0.05 : 0.5;
      const Mesh mesh = surface.to_mesh(tolerance);
      const mesh::Audit a = audit(mesh);
      EXPECT_EQ(a.components, 1U);
      EXPECT_EQ(a.nonmanifold_edges, 0U);
      // Its border is one loop, along the patch's: V - E + F of a disc is 1.
      const std::size_t edges = (3 * mesh.triangles.size() + a.open_edges) / 2;
      EXPECT_EQ(mesh.vertices.size() + mesh.triangles.size(), edges + 1);
      const mesh::Closest near(mesh);
      for (const Vec2& uv : shapes::grid(patch, 40))
        EXPECT_LE(near(shapes::by_definition(patch, uv)).distance, tolerance);
      std::vector<Vec3> points = points_of(mesh);
      if (points.size() > 500) points.resize(500);
      for (const Foot& foot : surface.closest(points)) EXPECT_LE(foot.distance, tolerance);
    }
}

TEST(SurfaceToMesh, OfFlatPatchesHasTwoTriangles) {
  Patch flat;
  flat.count_u = flat.count_v = 2;
  flat.points = {{0, 0, 0}, {0, 5, 0}, {4, 0, 0}, {4, 5, 0}};
  flat.weights = {1, 1, 1, 1};
  flat.knots_u = {-7, -7, 2, 2}, flat.knots_v = {100, 100, 101, 101};
  const Mesh mesh = Surface({flat}).to_mesh(1e-6);
  EXPECT_EQ(mesh.triangles.size(), 2U);
  EXPECT_DOUBLE_EQ(area(mesh), 20);
}

TEST(SurfaceToMesh, RefusesTolerancesThatItCannotKeep) {
  const Surface ball({shapes::ball(10)});
  for (const double bad : {0.0, -1.0, 1e-9, std::nan("")})
    EXPECT_NE(error_of([&] { ball.to_mesh(bad); }).find("tolerance"), std::string::npos);
  EXPECT_NE(error_of([&] { ball.to_mesh(1e-7); }).find("50 million"), std::string::npos);
  const Surface far({shapes::ball(10, 4, {1e5, 0, 0})});
  EXPECT_NE(error_of([&] { far.to_mesh(1e-6); }).find("largest coordinate"), std::string::npos);
}

}  // namespace
}  // namespace riffler::nurbs::to_mesh_test
