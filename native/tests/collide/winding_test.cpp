#include "collide/winding.hpp"

#include <gtest/gtest.h>

#include "mesh/shapes.hpp"

namespace riffler {
namespace {

TEST(Winding, IsOneInsideOfAClosedSurfaceAndZeroOutside) {
  const Surface sphere(sphere_mesh(10, 4)), box(box_mesh({0, 0, 0}, {1, 2, 3}));
  EXPECT_NEAR(winding_number(sphere, {1, 2, 3}), 1, 1e-12);
  EXPECT_NEAR(winding_number(sphere, {9, 9, 9}), 0, 1e-12);
  EXPECT_NEAR(winding_number(box, {1e-6, 1e-6, 1e-6}), 1, 1e-9);
  EXPECT_NEAR(winding_number(box, {-1e-6, 1, 1}), 0, 1e-9);
}

TEST(Winding, OfASquareSeenFromAHalfItsSideAboveItIsASixth) {
  Mesh square;
  square.vertices = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_NEAR(winding_number(Surface(square), {0, 0, -1}), 1.0 / 6, 1e-12);
  EXPECT_NEAR(winding_number(Surface(square), {0, 0, 1}), -1.0 / 6, 1e-12);
}

TEST(Winding, IsFiniteOnVerticesAndForTrianglesWithoutArea) {
  Mesh flat = box_mesh({0, 0, 0}, {1, 1, 1});
  flat.triangles.emplace_back(0, 0, 1);
  for (const Vec3& v : flat.vertices) EXPECT_TRUE(std::isfinite(winding_number(Surface(flat), v)));
}

}  // namespace
}  // namespace riffler
