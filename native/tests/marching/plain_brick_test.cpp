// Flat bricks that are made only partly.
#include "marching/plain_brick.hpp"

#include <gtest/gtest.h>

#include <array>

#include "marching/mesh_state.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::marching::plain_brick_test {
namespace {

TEST(PlainBrick, FilledHasTheBytesOfTheFullMesh) {
  for (const char* directions : {"xyz", "z", "x"}) {
    Volume volume = Volume::block({{{-3, 5, 1}, {41, 47, 33}}, 0.25, directions});
    sweep::carve(volume, cutters::ball(4, 40), std::array{Pose{{2, 12, 31}, {0, 0, 1}}, Pose{{30, 19, 32}, {0, 0, 1}}});
    const MeshState full(volume, false, {});
    MeshState state(volume, false, {}, true);
    std::array<int, 3> planes{};
    for (const std::size_t n : state.active_bricks()) {
      ActiveBrick& brick = *state.bricks.active(n);
      EXPECT_EQ(brick.hollow, brick.plain.has_value());
      EXPECT_FALSE(full.bricks.active(n)->hollow);
      if (brick.plain) ++planes[static_cast<std::size_t>(brick.plain->axis)];
      make_rest(state.surface, brick);
    }
    for (const int count : planes) EXPECT_GE(count, 6) << directions;
    EXPECT_EQ(state.surface.mesh.vertices, full.surface.mesh.vertices) << directions;
    EXPECT_EQ(state.surface.mesh.triangles, full.surface.mesh.triangles) << directions;
    EXPECT_EQ(state.surface.marks, full.surface.marks) << directions;
  }
}

TEST(PlainBrick, TheTrianglesOfItsSquareCoverIt) {
  const FlatSquare& square = flat_square();
  EXPECT_EQ(square.vertices.size(), 125U);
  EXPECT_EQ(square.triangles.size(), 128U);
  int doubled = 0;
  for (const auto& t : square.triangles) {
    const auto place = [&](int c) { return Vec2(t[c] / kBrickSide, t[c] % kBrickSide); };
    const Vec2 a = place(1) - place(0), b = place(2) - place(0);
    const double area = a.x * b.y - a.y * b.x;
    EXPECT_GT(area, 0);
    doubled += static_cast<int>(area);
  }
  EXPECT_EQ(doubled, 2 * 30 * 30);
}

}  // namespace
}  // namespace riffler::marching::plain_brick_test
