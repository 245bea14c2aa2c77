#include "collide/winding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/shapes.hpp"
#include "stress/random.hpp"

namespace riffler::collide::winding_test {
namespace {

/// What of a mesh is below a height.
Mesh open_above(Mesh mesh, double z) {
  std::erase_if(mesh.triangles, [&](const Vec3i& t) {
    return mesh.vertices[t.x].z > z || mesh.vertices[t.y].z > z || mesh.vertices[t.z].z > z;
  });
  return mesh;
}

TEST(Winding, IsOneInsideAClosedSurfaceAndZeroOutside) {
  const Surface sphere(mesh::sphere_mesh(10, 4)), box(mesh::box_mesh({0, 0, 0}, {1, 2, 3}));
  EXPECT_NEAR(WindingNumber(sphere)({1, 2, 3}), 1, 1e-2);
  EXPECT_NEAR(WindingNumber(sphere)({9, 9, 9}), 0, 1e-2);
  EXPECT_NEAR(WindingNumber(box)({1e-6, 1e-6, 1e-6}), 1, 1e-9);
  EXPECT_NEAR(WindingNumber(box)({-1e-6, 1, 1}), 0, 1e-9);
}

TEST(Winding, IsWithinAHundredthOfTheSumOverAllTriangles) {
  // The reference: solid angles by l'Huilier's theorem from the sides of spherical triangles.
  const auto angle = [](const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
  };
  for (const Mesh& mesh : {mesh::torus_mesh(10, 3, 90, 40), open_above(mesh::sphere_mesh(10, 4), 4)}) {
    const Surface surface(mesh);
    const WindingNumber winding(surface);
    stress::Random random(3);
    for (int n = 0; n < 300; ++n) {
      const Vec3 p = random.uniform(0, 14) * random.direction();
      double sum = 0;
      for (const Vec3i& t : mesh.triangles) {
        const Vec3 u = mesh.vertices[t.x] - p, v = mesh.vertices[t.y] - p, w = mesh.vertices[t.z] - p;
        const double a = angle(v, w), b = angle(w, u), c = angle(u, v), s = 0.5 * (a + b + c);
        const double root = std::tan(s / 2) * std::tan((s - a) / 2) * std::tan((s - b) / 2) * std::tan((s - c) / 2);
        sum += std::copysign(4 * std::atan(std::sqrt(std::max(0.0, root))), glm::dot(u, glm::cross(v, w)));
      }
      EXPECT_NEAR(winding(p), sum / (4 * 3.141592653589793), 1e-2);
    }
  }
}

TEST(Winding, OfASquareSeenFromAHalfItsSideAboveItIsASixth) {
  Mesh square;
  square.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  const Surface surface(square);
  EXPECT_NEAR(WindingNumber(surface)({0, 0, -1}), 1.0 / 6, 1e-12);
  EXPECT_NEAR(WindingNumber(surface)({0, 0, 1}), -1.0 / 6, 1e-12);
}

TEST(Winding, IsFiniteOnVerticesAndForTrianglesWithoutArea) {
  Mesh flat = mesh::box_mesh({0, 0, 0}, {1, 1, 1});
  flat.triangles.emplace_back(0, 0, 1);
  const Surface surface(flat);
  for (const Vec3& v : flat.vertices) EXPECT_TRUE(std::isfinite(WindingNumber(surface)(v)));
}

}  // namespace
}  // namespace riffler::collide::winding_test
