// The judge of meshes, compared with a look at every triangle.
#include "bench/mesh_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh/shapes.hpp"
#include "stress/random.hpp"

namespace riffler::bench::mesh_distance_test {
namespace {

double by_every_triangle(const Vec3& p, const Mesh& mesh) {
  double least = 1e300;
  for (const Vec3i& t : mesh.triangles)
    least = std::min(least, bench::squared_distance(p, mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]));
  return std::sqrt(least);
}

TEST(MeshDistance, IsThatToTheNearestTriangle) {
  stress::Random random(5);
  for (const double thin : {1.0, 1e-3, 40.0}) {  // large flat triangles next to short ones, and slivers
    Mesh mesh = mesh::sphere_mesh(1, 3);
    for (Vec3& v : mesh.vertices) v.z *= thin;
    const int base = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{-30, -30, 3}, {30, -31, 4}, {0, 40, 5}});
    mesh.triangles.push_back({base, base + 1, base + 2});
    std::vector<Vec3> points;
    for (int n = 0; n < 400; ++n) {  // close to the mesh, on it, and away from it by some cells
      const Vec3i& t = mesh.triangles[random.one_in(3) ? mesh.triangles.size() - 1 : random.below(512)];
      const double a = random.uniform(), b = random.uniform(0, 1 - a);
      const Vec3 on = mesh.vertices[t.x] + a * (mesh.vertices[t.y] - mesh.vertices[t.x]) +
                      b * (mesh.vertices[t.z] - mesh.vertices[t.x]);
      points.push_back(on + (n % 4 ? random.power_of_ten(-9, 0.5) : 0.0) * random.direction());
    }
    const bench::MeshDistance distance(mesh);
    const std::vector<double> found = distance(points);
    double worst = 0, expected = 0;
    int near = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double every = by_every_triangle(points[n], mesh);
      EXPECT_NEAR(found[n], every, 1e-12) << n << ", " << thin;
      EXPECT_NEAR(distance(points[n], 0, &near), every, 1e-12) << n << ", " << thin;
      worst = std::max(worst, distance(points[n], worst, &near)), expected = std::max(expected, every);
      EXPECT_NEAR(worst, expected, 1e-12) << n << ", " << thin;
    }
    EXPECT_NEAR(distance.farthest(points), expected, 1e-12) << thin;
    EXPECT_EQ(distance.farthest({}), 0);
  }
}

TEST(MeshDistance, ToATriangleIsThatToItsPlaneSidesOrCorners) {
  const Vec3 a{0, 0, 0}, b{4, 0, 0}, c{0, 3, 0};
  EXPECT_DOUBLE_EQ(bench::squared_distance({1, 1, 2}, a, b, c), 4);
  EXPECT_DOUBLE_EQ(bench::squared_distance({2, -1, 0}, a, b, c), 1);
  EXPECT_DOUBLE_EQ(bench::squared_distance({7, -4, 0}, a, b, c), 25);
  EXPECT_DOUBLE_EQ(bench::squared_distance({4, 3, 0}, a, b, c), 144.0 / 25);
  EXPECT_DOUBLE_EQ(bench::squared_distance({1, 1, 1}, a, b, a), 2) << "a triangle without area is its side";
}

}  // namespace
}  // namespace riffler::bench::mesh_distance_test
