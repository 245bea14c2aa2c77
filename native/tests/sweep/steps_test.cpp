// How a cutter is taken apart before it is swept, and what of a move is looked at.
#include <gtest/gtest.h>

#include "reference/swept_distance.hpp"
#include "sweep/carve.hpp"
#include "sweep/turning_part.hpp"
#include "tool/cutters.hpp"

namespace riffler {
namespace {

TEST(ConvexGroups, NamedCuttersAreOne) {
  for (const Tool& tool :
       {cutters::ball(6, 30), cutters::ball(6, 3), cutters::flat(6, 30), cutters::fillet(8, 1, 30),
        cutters::taper(0.5, 0.2, 8, 40), cutters::taper(0.5, 0.2, 8, 40, true), cutters::cone_end(1.0, 1, 0.4, 8, 40)})
    EXPECT_EQ(convex_groups(tool.cutter()).size(), 1U) << tool.kind();
}

Tool waisted() {
  return cutters::profile({{{1.5, 0}, {}}, {{3, 1.5}, Vec2(1.5, 1.5)}, {{2, 6}, {}}, {{4, 8}, {}}}, 30);
}

Tool corner_rounder(double r) {
  return cutters::profile({{{r / 4, 0}, {}}, {{r / 4, r / 4}, {}}, {{r, r}, Vec2(r, r / 4)}}, 4 * r);
}

TEST(ConvexGroups, OverlapWhereTheToolIsHollowAndStayWithinIt) {
  for (const Tool& tool : {waisted(), corner_rounder(4)}) {
    const reference::CutterDistance distance(tool.profile());
    const std::vector<ConvexGroup> groups = convex_groups(tool.cutter());
    ASSERT_GT(groups.size(), 1U);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (g > 0) {
        EXPECT_LT(bottom(groups[g].pieces[0]), top(groups[g - 1].pieces[groups[g - 1].count - 1]));
      }
      for (const Piece& piece : groups[g].all())
        for (int k = 0; k <= 20; ++k) {
          const double z = bottom(piece) + (top(piece) - bottom(piece)) * k / 20;
          EXPECT_LE(distance.distance(radius_at(piece, z), z), 1e-9) << "height " << z;
        }
    }
  }
}

TEST(HollowArcs, HaveNoConesThatAreRounding) {
  for (int k = 1; k <= 2000; ++k) {
    const double r = 0.37 * k;
    const Tool tool = corner_rounder(r);
    for (const Piece& piece : tool.cutter()) EXPECT_GT(top(piece) - bottom(piece), 1e-9 * r) << r;
  }
}

TEST(Carve, AMoveThatComesFromFarAwayIsExactWhereItMatters) {
  const Tool tool = cutters::cone_end(1.1, 2.5, 0.4, 20, 90);
  const Pose from{{18749528.76, -2756265.76, 73167652.37}, {-1, 0, 0}};
  const Pose to{{-3950480.9, 583834.13, -15415761.98}, {-1, 0, 0}};
  // The way is shifted so that it passes through the block.
  const double t = from.tip.z / (from.tip.z - to.tip.z);
  const Vec3 shift = Vec3(40, 20, 20) - (from.tip + t * (to.tip - from.tip));
  const Pose a{from.tip + shift, from.axis}, b{to.tip + shift, to.axis};
  Volume volume = Volume::block({{{0, 0, 0}, {50, 40, 40}}, 1.7, "xyz"});
  carve(volume, tool, std::vector<Pose>{a, b});
  // The same straight line, near the block only.
  const Vec3 way = glm::normalize(b.tip - a.tip);
  const Motion near({Vec3(40, 20, 20) - 300.0 * way, a.axis}, {Vec3(40, 20, 20) + 300.0 * way, a.axis});
  const reference::SweptDistance swept(tool.profile(), near);
  int ends = 0;
  for (const Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        for (const Span& s : grid.ray(i, j))
          for (const double end : {s.near, s.far})
            if (end > grid.box().lower.z && end < grid.box().upper.z) {
              const Vec3 p = to_world(grid.axis(), {grid.shifted_u(i), grid.shifted_v(j), end});
              EXPECT_LE(std::abs(swept(p)), 1e-6) << ++ends;
            }
}

/// Two rays of this block meet the line that the cone's apex sweeps: both roots of the ridge fall together there.
TEST(Carve, ARayThroughTheLineOfAnApexKeepsItsRidge) {
  const Tool tool = cutters::cone_end(1.0, 1, 0.4, 8, 40);
  const Vec3 axis = glm::normalize(Vec3(0.3, -0.5, 1));
  const Pose from{{20, 20, 26}, axis}, to{{40, 33, 21}, axis};
  Volume volume = Volume::block({{{0, 0, 0}, {100, 60, 30}}, 0.25, "x"});
  carve(volume, tool, std::vector<Pose>{from, to});
  const reference::SweptDistance swept(tool.profile(), Motion(from, to));
  const Grid& grid = volume.grids()[0];
  for (const auto& [i, j] : {std::pair{99, 96}, {112, 91}})
    for (const Span& s : grid.ray(i, j))
      for (const double end : {s.near, s.far})
        if (end > 0 && end < 100) {
          EXPECT_LE(std::abs(swept({end, grid.shifted_u(i), grid.shifted_v(j)})), 1e-7);
        }
}

}  // namespace
}  // namespace riffler
