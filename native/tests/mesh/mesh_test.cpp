#include "riffler/mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "mesh/shapes.hpp"

namespace riffler::mesh::mesh_test {
namespace {

std::string message_of(const Mesh& mesh) {
  try {
    validate(mesh);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "";
}

TEST(Mesh, MeasuresABox) {
  const Mesh mesh = box_mesh({-1, 2, 3}, {4, 5, 7});
  EXPECT_DOUBLE_EQ(volume(mesh), 60);
  EXPECT_DOUBLE_EQ(area(mesh), 2 * (15 + 12 + 20));
  EXPECT_EQ(bounds(mesh).lower, Vec3(-1, 2, 3));
  EXPECT_EQ(bounds(mesh).upper, Vec3(4, 5, 7));
}

TEST(Mesh, VolumeKeepsItsDigitsFarFromTheOrigin) {
  // Coordinates near 1e5 are rounded to 1.5e-11 mm: more than 60 mm³ × 1e-10 would be the formula's fault.
  const Mesh mesh = subdivided(box_mesh({0, 0, 0}, {5, 3, 4}), 3);
  for (const Vec3& by : {Vec3(1e5, -1e5, 1e5), Vec3(1e5, 0, 0), Vec3(-3e5, 2e5, 1e5)})
    EXPECT_NEAR(volume(moved(mesh, by)), 60, 6e-9);
}

TEST(Mesh, TurnedInsideOutHasNegativeVolume) {
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  for (Vec3i& t : mesh.triangles) std::swap(t.y, t.z);
  EXPECT_DOUBLE_EQ(volume(mesh), -1);
}

TEST(Mesh, EmptyMeshMeasuresNothing) {
  EXPECT_EQ(volume({}), 0);
  EXPECT_EQ(area({}), 0);
  EXPECT_TRUE(bounds({}).empty());
  EXPECT_NO_THROW(validate({}));
}

TEST(Mesh, BoundsAreThoseOfTheTriangles) {
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  mesh.vertices.emplace_back(100, 100, 100);  // of no triangle
  EXPECT_EQ(bounds(mesh).upper, Vec3(1, 1, 1));
  EXPECT_DOUBLE_EQ(volume(mesh), 1);
}

TEST(Mesh, ValidateNamesTheRow) {
  Mesh mesh = box_mesh({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(message_of(mesh), "");
  mesh.vertices[5].y = std::nan("");
  EXPECT_EQ(message_of(mesh), "vertices, row 5: not finite");
  mesh.vertices[5].y = -1.1e30;
  EXPECT_EQ(message_of(mesh), "vertices, row 5: beyond 1e30");
  mesh.vertices[5].y = 1e30;
  EXPECT_EQ(message_of(mesh), "");
  mesh.triangles[7].z = 8;
  EXPECT_EQ(message_of(mesh), "triangles, row 7: no vertex 8: there are 8, counted from 0");
  mesh.triangles[7].z = -1;
  EXPECT_EQ(message_of(mesh), "triangles, row 7: no vertex -1: there are 8, counted from 0");
}

}  // namespace
}  // namespace riffler::mesh::mesh_test
