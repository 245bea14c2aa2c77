#include "riffler/mesh/smooth.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "mesh/io/stl.hpp"
#include "mesh/shapes.hpp"
#include "riffler/mesh/audit.hpp"

namespace riffler::mesh::smooth_test {
namespace {

Mesh rough_sphere(double height) {
  Mesh mesh = sphere_mesh(10, 5);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> step(1 - height / 10, 1 + height / 10);
  for (Vec3& v : mesh.vertices) v *= step(random);
  return mesh;
}

double roughness(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3& v : mesh.vertices) sum += (glm::length(v) - 10) * (glm::length(v) - 10);
  return std::sqrt(sum / static_cast<double>(mesh.vertices.size()));
}

TEST(Smooth, RemovesRoughnessAndKeepsTheSize) {
  const Mesh mesh = rough_sphere(0.05);
  const Mesh result = smooth(mesh, 20);
  EXPECT_LT(roughness(result), roughness(mesh) / 2);
  EXPECT_NEAR(volume(result) / volume(sphere_mesh(10, 5)), 1, 0.002);
  EXPECT_EQ(result.triangles, mesh.triangles);
  EXPECT_TRUE(audit(from_stl(to_stl(result), "part")).watertight());
}

TEST(Smooth, KeepsTheVolume) {
  const Mesh rough = rough_sphere(0.05);
  for (const int n : {1, 10, 50}) {
    // What is left over are the vertices that went back.
    EXPECT_NEAR(volume(smooth(rough, n)) / volume(rough), 1, 1e-6);
    EXPECT_NEAR(volume(smooth(rough, n, 0.03)) / volume(rough), 1, 1e-6);
  }
  // A smooth body does not change to make up for the volume of the rough one.
  Mesh both_bodies = both(box_mesh({20, 0, 0}, {24, 5, 6}), rough);
  const Mesh result = smooth(both_bodies, 20);
  for (std::size_t v = 0; v < 8; ++v) EXPECT_EQ(result.vertices[v], both_bodies.vertices[v]);
}

/// Distance of p from the surface of the box 0 … size.
double off_box(const Vec3& p, const Vec3& size) {
  const Vec3 q = glm::abs(p - 0.5 * size) - 0.5 * size;
  return std::fabs(glm::length(glm::max(q, Vec3(0))) + std::fmin(0, std::fmax(q.x, std::fmax(q.y, q.z))));
}

TEST(Smooth, EdgesAndCornersStaySharp) {
  const Vec3 size(10, 8, 6);
  const Mesh flat = subdivided(box_mesh({0, 0, 0}, size), 4);
  for (const Vec3& v : smooth(flat, 20).vertices) EXPECT_LT(off_box(v, size), 1e-14);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> step(-0.02, 0.02);
  Mesh rough = flat;
  for (Vec3& v : rough.vertices) v += Vec3(step(random), step(random), step(random));
  const auto mean_off = [&](const Mesh& mesh) {
    double sum = 0, worst = 0;
    for (const Vec3& v : mesh.vertices) sum += off_box(v, size), worst = std::fmax(worst, off_box(v, size));
    EXPECT_LT(worst, 0.05);
    return sum / static_cast<double>(mesh.vertices.size());
  };
  const Mesh result = smooth(rough, 20);
  EXPECT_LT(mean_off(result), mean_off(rough) / 1.8);
  for (std::size_t v = 0; v < 8; ++v) EXPECT_EQ(result.vertices[v], rough.vertices[v]);  // the corners
  EXPECT_NEAR(volume(result) / volume(rough), 1, 1e-6);
  // Without features the edges go: the same call with every edge taken for a smooth one.
  const Mesh round = smooth(rough, 20, {}, 3.14);
  double worst = 0;
  for (const Vec3& v : round.vertices) worst = std::fmax(worst, off_box(v, size));
  EXPECT_GT(worst, 0.1);
}

TEST(Smooth, NoVertexMovesFartherThanTheTolerance) {
  const Mesh mesh = rough_sphere(0.05);
  for (const double tolerance : {0.0, 0.001, 0.01}) {
    const Mesh result = smooth(mesh, 15, tolerance);
    double farthest = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      farthest = std::fmax(farthest, glm::length(result.vertices[v] - mesh.vertices[v]));
    EXPECT_LE(farthest, tolerance + 1e-14);
    EXPECT_GE(farthest, 0.99 * tolerance);  // rough enough to want more
  }
}

TEST(Smooth, BordersStay) {
  const Mesh mesh = sheet_mesh(10, 10, [](double x, double y) { return std::sin(3 * x + 5 * y); });
  const Mesh result = smooth(mesh, 10);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Vec3& p = mesh.vertices[v];
    if (p.x == 0 || p.x == 10 || p.y == 0 || p.y == 10) {
      EXPECT_EQ(result.vertices[v], p);
    }
  }
  EXPECT_NE(result.vertices, mesh.vertices);
}

TEST(Smooth, NothingFoldsOrMeets) {
  // Spikes and slivers: a sphere whose vertices were thrown about by more than their distance.
  Mesh mesh = sphere_mesh(10, 4);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> step(-0.4, 0.4);
  for (Vec3& v : mesh.vertices) v += Vec3(step(random), step(random), step(random));
  const Audit before = audit(mesh);
  for (const int n : {1, 10, 100}) {
    const Mesh result = from_stl(to_stl(smooth(mesh, n)), "part");
    const Audit after = audit(result);
    EXPECT_TRUE(after.watertight());
    EXPECT_LE(after.folds, before.folds);
    EXPECT_LE(after.degenerate, before.degenerate);
    EXPECT_EQ(result.vertices.size(), mesh.vertices.size());
  }
}

TEST(Smooth, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = rough_sphere(0.05);
  setenv("RIFFLER_THREADS", "1", 1);
  const Mesh one = smooth(mesh, 5, 0.02);
  setenv("RIFFLER_THREADS", "4", 1);
  const Mesh four = smooth(mesh, 5, 0.02);
  unsetenv("RIFFLER_THREADS");
  EXPECT_EQ(one.vertices, four.vertices);
}

TEST(Smooth, SurvivesEmptyAndDegenerateMeshes) {
  EXPECT_TRUE(smooth({}, 3).empty());
  const Mesh mesh = rough_sphere(0.05);
  EXPECT_EQ(smooth(mesh, 0).vertices, mesh.vertices);
  EXPECT_THROW(smooth(mesh, -1), std::invalid_argument);
  EXPECT_THROW(smooth(mesh, 1, -0.1), std::invalid_argument);
  EXPECT_THROW(smooth(mesh, 1, std::nan("")), std::invalid_argument);
  for (const double angle : {0.0, -1.0, 4.0, std::nan("")})
    EXPECT_THROW(smooth(mesh, 1, {}, angle), std::invalid_argument);
  EXPECT_THROW(smooth(mesh, 5, {}, [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace riffler::mesh::smooth_test
