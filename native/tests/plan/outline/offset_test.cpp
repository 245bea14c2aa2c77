// Loops at a distance from silhouettes and curves, checked against distances from known shapes.
#include "plan/outline/offset.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "geom/math.hpp"

namespace riffler::plan::offset_test {
namespace {

using Curves = std::vector<std::vector<Vec2>>;

constexpr double kRadius = 2, kTolerance = 0.01;

PlaceGrid grid_of(const SetBorder& border) {
  PlaceGrid grid;
  grid.spacing = kRadius / 8, grid.lower = border.lower() - Vec2(2 * kRadius + 0.09, 2 * kRadius + 0.07);
  const Vec2 size = border.upper() - grid.lower + Vec2(2 * kRadius);
  grid.columns = static_cast<int>(size.x / grid.spacing) + 2, grid.rows = static_cast<int>(size.y / grid.spacing) + 2;
  return grid;
}

OffsetLoops around(const Curves& curves, bool inside = false) {
  const SetBorder border(curve_segments(curves), kRadius);
  const PlaceGrid grid = grid_of(border);
  PlaceSet set = within(grid, curves);
  if (inside)
    for (char& k : set) k = !k;
  return offset_loops(grid, set, border, kRadius, kTolerance);
}

std::vector<Vec2> rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

double outside(const Vec2& p, double x0, double y0, double x1, double y1) {
  const double dx = std::max(x0 - p.x, p.x - x1), dy = std::max(y0 - p.y, p.y - y1);
  return dx > 0 && dy > 0 ? std::sqrt(dx * dx + dy * dy) : std::max(dx, dy);
}

/// Calls visit(p) for closely spaced points on the loop.
template <class Visit>
void each_place(const std::vector<Vec2>& loop, const Visit& visit) {
  for (std::size_t k = 0; k < loop.size(); ++k)
    for (int i = 0; i < 20; ++i) visit(glm::mix(loop[k], loop[(k + 1) % loop.size()], i / 20.0));
}

TEST(Offset, KeepsItsDistanceFromARectangleOnEveryMove) {
  const OffsetLoops found = around({rectangle(0, 0, 12, 7)});
  ASSERT_EQ(found.loops.size(), 1u);
  EXPECT_TRUE(found.narrow.empty());
  double least = kInfinity, most = 0;
  each_place(found.loops[0], [&](const Vec2& p) {
    const double d = outside(p, 0, 0, 12, 7);
    least = std::min(least, d), most = std::max(most, d);
  });
  EXPECT_GE(least, kRadius);
  EXPECT_LE(most, kRadius + kTolerance);
}

TEST(Offset, ReachesIntoCornersFromInsideAsFarAsADiscDoes) {
  const OffsetLoops found = around({rectangle(0, 0, 12, 7)}, true);
  ASSERT_EQ(found.loops.size(), 1u);
  double least = kInfinity;
  each_place(found.loops[0], [&](const Vec2& p) { least = std::min(least, -outside(p, 0, 0, 12, 7)); });
  EXPECT_GE(least, kRadius);
  for (const Vec2 corner : {Vec2(2, 2), Vec2(10, 2), Vec2(10, 5), Vec2(2, 5)}) {
    double near = kInfinity;
    each_place(found.loops[0], [&](const Vec2& p) { near = std::min(near, glm::length(p - corner)); });
    EXPECT_LE(near, 0.02);
  }
}

TEST(Offset, NamesOpeningsWithoutRoomAndGoesIntoTheOthers) {
  const OffsetLoops found = around({rectangle(0, 0, 30, 14), rectangle(3, 3, 11, 11), rectangle(16, 5, 19.4, 12)});
  EXPECT_EQ(found.loops.size(), 2u);
  ASSERT_EQ(found.narrow.size(), 1u);
  EXPECT_NEAR(found.narrow[0].width, 3.4, 0.03);
  EXPECT_NEAR(found.narrow[0].place.x, 17.7, 0.02);
}

TEST(Offset, HasNothingInsideOfWhatIsNarrowerThanTheDisc) {
  const OffsetLoops found = around({rectangle(0, 0, 12, 3.9)}, true);
  EXPECT_TRUE(found.loops.empty());
  ASSERT_EQ(found.narrow.size(), 1u);
}

TEST(SetBorder, KnowsTheSilhouetteOfAnUnweldedAndOpenMesh) {
  // A square of two triangles that share no vertices, and a smaller triangle above its middle.
  Mesh mesh;
  mesh.vertices = {{0, 0, 0},  {10, 0, 0}, {10, 10, 0}, {0, 0, 0}, {10, 10, 0},
                   {0, 10, 0}, {4, 4, 5},  {6, 4, 5},   {5, 6, 5}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  const std::vector<SetBorder::Segment> segments = silhouette_segments(mesh);
  EXPECT_EQ(segments.size(), 7u) << "four sides, no diagonal, and the small triangle's";
  const SetBorder border(segments, kRadius);
  const PlaceGrid grid = grid_of(border);
  const OffsetLoops found = offset_loops(grid, covered(grid, mesh), border, kRadius, kTolerance);
  ASSERT_EQ(found.loops.size(), 1u) << "nothing within the silhouette";
  EXPECT_TRUE(found.narrow.empty());
  double least = kInfinity, most = 0;
  each_place(found.loops[0], [&](const Vec2& p) {
    least = std::min(least, outside(p, 0, 0, 10, 10)), most = std::max(most, outside(p, 0, 0, 10, 10));
  });
  EXPECT_GE(least, kRadius);
  EXPECT_LE(most, kRadius + kTolerance);
}

TEST(SetBorder, MeasuresLinesThatCrossAndThatDoNot) {
  const SetBorder border({{{0, 0}, {10, 0}}}, 1);
  EXPECT_EQ(border.distance({5, -1}, {5, 1}, 4), 0);
  EXPECT_NEAR(border.distance({11, -1}, {11, 1}, 4), 1, 1e-12);
  EXPECT_EQ(border.distance({5, 9}, {6, 9}, 4), 4);
  Vec2 q;
  EXPECT_FALSE(border.nearest({5, 9}, 4, q));
  EXPECT_TRUE(border.nearest({5, 3}, 4, q));
  EXPECT_EQ(q, Vec2(5, 0));
}

}  // namespace
}  // namespace riffler::plan::offset_test
