#include "mesh/smooth.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "mesh/audit.hpp"
#include "mesh/shapes.hpp"
#include "mesh/stl.hpp"

namespace riffler {
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

TEST(Smooth, TakesRoughnessAwayAndKeepsTheSize) {
  const Mesh mesh = rough_sphere(0.05);
  const Mesh result = smooth(mesh, 20);
  EXPECT_LT(roughness(result), roughness(mesh) / 2);
  EXPECT_NEAR(volume(result) / volume(sphere_mesh(10, 5)), 1, 0.002);
  EXPECT_EQ(result.triangles, mesh.triangles);
  EXPECT_TRUE(audit(from_stl(to_stl(result), "part")).watertight());
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

TEST(Smooth, OddInputs) {
  EXPECT_TRUE(smooth({}, 3).empty());
  const Mesh mesh = rough_sphere(0.05);
  EXPECT_EQ(smooth(mesh, 0).vertices, mesh.vertices);
  EXPECT_THROW(smooth(mesh, -1), std::invalid_argument);
  EXPECT_THROW(smooth(mesh, 1, -0.1), std::invalid_argument);
  EXPECT_THROW(smooth(mesh, 1, std::nan("")), std::invalid_argument);
  EXPECT_THROW(smooth(mesh, 5, {}, [](double) { return false; }), Cancelled);
}

}  // namespace
}  // namespace riffler
