#include "mesh/smooth_normals.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace riffler::mesh::smooth_normals_test {
namespace {

/// A cylinder of radius 10 about z between 0 and 20, open, its n × 1 cells cut along either diagonal.
Mesh tube(int n, bool other_diagonal) {
  Mesh mesh;
  for (int k = 0; k < n; ++k)
    for (const double z : {0.0, 20.0}) {
      const double t = 2 * kPi * k / n;
      mesh.vertices.push_back({10 * std::cos(t), 10 * std::sin(t), z});
    }
  for (int k = 0; k < n; ++k) {
    const int a = 2 * k, b = 2 * ((k + 1) % n);
    if (other_diagonal)
      mesh.triangles.push_back({a, b, a + 1}), mesh.triangles.push_back({b, b + 1, a + 1});
    else
      mesh.triangles.push_back({a, b, b + 1}), mesh.triangles.push_back({a, b + 1, a + 1});
  }
  return mesh;
}

TEST(SmoothNormals, FollowARoundSurfaceForAnyTriangulation) {
  for (const bool other : {false, true}) {
    const Mesh mesh = tube(24, other);
    const SmoothNormals normals(mesh, 0.6);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const Vec3 corner = mesh.vertices[mesh.triangles[t][k]];
        const Vec3 out = glm::normalize(Vec3(corner.x, corner.y, 0));
        EXPECT_LT(glm::length(normals.at(static_cast<int>(t), corner) - out), 1e-12);
      }
  }
}

TEST(SmoothNormals, KeepFacesApartThatMeetAtAnEdge) {
  const Mesh mesh = tube(4, false);
  const SmoothNormals normals(mesh, 0.6);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3i& v = mesh.triangles[t];
    const Vec3 a = mesh.vertices[v.x], b = mesh.vertices[v.y], c = mesh.vertices[v.z];
    const Vec3 face = glm::normalize(glm::cross(b - a, c - a));
    for (const Vec3& p : {a, b, c, (a + b + c) / 3.0})
      EXPECT_LT(glm::length(normals.at(static_cast<int>(t), p) - face), 1e-12);
  }
}

TEST(SmoothNormals, OfATriangleWithoutAreaComeFromItsNeighbours) {
  Mesh mesh = tube(24, false);
  const int middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(0.5 * (mesh.vertices[0] + mesh.vertices[1]));
  mesh.triangles.push_back({0, middle, 1});
  mesh.triangles.push_back({middle, middle, middle});
  const SmoothNormals normals(mesh, 0.6);
  const int flat = static_cast<int>(mesh.triangles.size()) - 2;
  EXPECT_LT(glm::length(normals.at(flat, mesh.vertices[middle]) - Vec3(1, 0, 0)), 0.2);
  const Vec3 nothing = normals.at(flat + 1, mesh.vertices[middle]);
  EXPECT_TRUE(geom::finite(nothing));
}

}  // namespace
}  // namespace riffler::mesh::smooth_normals_test
