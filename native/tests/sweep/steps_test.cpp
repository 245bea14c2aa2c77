// How a cutter is taken apart before it is swept, and which part of a move is looked at.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "reference/swept_distance.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"
#include "sweep/convex_group.hpp"
#include "sweep/turning_part.hpp"

namespace riffler::sweep::steps_test {
namespace {

TEST(ConvexGroups, NamedCuttersAreOneGroup) {
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
      for (const tool::Piece& piece : groups[g].all())
        for (int k = 0; k <= 20; ++k) {
          const double z = bottom(piece) + (top(piece) - bottom(piece)) * k / 20;
          EXPECT_LE(distance.distance(radius_at(piece, z), z), 1e-9) << "height " << z;
        }
    }
  }
}

/// Points of the group's outline in the plane of radius and height.
std::vector<Vec2> outline(const TurningBody& body) {
  std::vector<Vec2> out;
  for (std::size_t k = 0; k < body.count; ++k) {
    const PieceShape& s = body.pieces[k];
    for (int i = 0; i <= 200; ++i) {
      const double z = s.z0 + (s.z1 - s.z0) * i / 200;
      const double arc = s.e + std::sqrt(std::max(0.0, s.r * s.r - (z - s.zc) * (z - s.zc)));
      out.emplace_back(s.round ? arc : s.r0 + (s.r1 - s.r0) * i / 200, z);
    }
  }
  return out;
}

/// Planes whose normal leans by `turn` = n · axis against the axis, at `offset` from the tip: they touch the group.
void expect_touching(const std::vector<Vec2>& points, double turn, double offset) {
  double most = -1e300;
  for (const Vec2& p : points) most = std::max(most, std::sqrt(1 - turn * turn) * p.x + turn * p.y);
  EXPECT_LE(most, offset + 1e-9) << "turn " << turn;
  EXPECT_GE(most, offset - 1e-3) << "turn " << turn;
}

TEST(TurningBody, PlanesTouchTheGroupInEveryDirection) {
  const Motion motion({{0, 0, 0}, {0, 0, 1}}, {{1, 0, 0}, glm::normalize(Vec3(0.1, 0.2, 1))});
  for (const Tool& tool :
       {cutters::flat(6, 30), cutters::fillet(8, 1, 30), cutters::taper(0.5, 0.2, 8, 40),
        cutters::taper(0.5, 0.2, 8, 40, true), cutters::cone_end(1.0, 1, 0.4, 8, 40), waisted(), corner_rounder(4)})
    for (ConvexGroup group : convex_groups(tool.cutter()))
      // As far as the tool reaches into the stock, its last piece is cut off.
      for (const double kept : {1.0, 0.4, 0.02}) {
        SCOPED_TRACE(tool.kind() + ", " + std::to_string(kept) + " of the last piece");
        tool::Piece& last = group.pieces[group.count - 1];
        if (auto* f = std::get_if<tool::Frustum>(&last)) {
          const double z = f->z0 + kept * (f->z1 - f->z0);
          last = tool::Frustum{f->z0, f->r0, z, radius_at(*f, z)};
        }
        const TurningBody body(group, motion, 0, 1, 0.01);
        const std::vector<Vec2> points = outline(body);
        std::vector<std::pair<double, double>> turns;
        for (std::size_t k = 0; k < body.count; ++k)
          if (const PieceShape& s = body.pieces[k]; !s.round) {
            expect_touching(points, -s.slope * s.cosine, s.support);
            turns.emplace_back(-s.slope * s.cosine, -s.slope * s.cosine);
          }
        for (std::size_t k = 0; k < body.rim_count; ++k) {
          const Rim& rim = body.rims[k];
          for (int i = 0; i <= 20; ++i) {
            const double turn = std::clamp(rim.turn0 + (rim.turn1 - rim.turn0) * i / 20, -1.0, 1.0);
            expect_touching(points, turn, std::sqrt(1 - turn * turn) * rim.radius + turn * rim.z + rim.thick);
          }
          turns.emplace_back(rim.turn0, rim.turn1);
        }
        std::sort(turns.begin(), turns.end());
        double reached = -1;
        for (const auto& [from, to] : turns) {
          EXPECT_LE(from, reached + 1e-8);
          reached = std::max(reached, to);
        }
        EXPECT_GE(reached, 1 - 1e-8);
      }
}

TEST(HollowArcs, HaveNoConesAsSmallAsRounding) {
  for (int k = 1; k <= 2000; ++k) {
    const double r = 0.37 * k;
    const Tool tool = corner_rounder(r);
    for (const tool::Piece& piece : tool.cutter()) EXPECT_GT(top(piece) - bottom(piece), 1e-9 * r) << r;
  }
}

TEST(Carve, AMoveThatComesFromFarAwayIsExactWhereItMatters) {
  const Tool tool = cutters::cone_end(1.1, 2.5, 0.4, 20, 90);
  const Pose from{{18749528.76, -2756265.76, 73167652.37}, {-1, 0, 0}};
  const Pose to{{-3950480.9, 583834.13, -15415761.98}, {-1, 0, 0}};
  // The path is shifted so that it passes through the block.
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
  for (const dexel::Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        for (const dexel::Span& s : grid.ray(i, j))
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
  const dexel::Grid& grid = volume.grids()[0];
  for (const auto& [i, j] : {std::pair{99, 96}, {112, 91}})
    for (const dexel::Span& s : grid.ray(i, j))
      for (const double end : {s.near, s.far})
        if (end > 0 && end < 100) {
          EXPECT_LE(std::abs(swept({end, grid.shifted_u(i), grid.shifted_v(j)})), 1e-7);
        }
}

/// The search for the end begins on the axis, where the distance from a barrel has an edge.
TEST(Carve, ARayOnABarrelsAxisIsCutAsDeepAsTheBarrelReaches) {
  const Tool tool = cutters::profile(
      {{{0.9375, 0}, {}}, {{2.8125, 5.625}, Vec2(-15.689056870495493, 8.667185623498499)}, {{3, 7.5}, {}}}, 104);
  const Vec3 start{27.75, 21.75, 39};
  for (const Vec3& way : {Vec3(2.435148541926, 0.190374136, -5.831180720), Vec3(2, 0, -4.5), Vec3(0, -3, -9)}) {
    const Pose from{start, {0, 0, 1}}, to{start + way, {0, 0, 1}};
    const reference::SweptDistance swept(tool.profile(), Motion(from, to));
    for (const double aside : {0.0, 5e-10, 1e-8, 1e-6, 1e-4, 1e-3, 1e-2}) {
      Volume volume = Volume::block({{{aside, aside / 2, 0}, {43.5 + aside, 37.5 + aside / 2, 39}}, 1.5, "z"});
      carve(volume, tool, std::vector<Pose>{from, to});
      const dexel::Grid& grid = volume.grids()[0];
      const auto ray = grid.ray(18, 14);
      ASSERT_EQ(ray.size(), 1U);
      EXPECT_LT(std::abs(swept({grid.shifted_u(18), grid.shifted_v(14), ray[0].far})), 1e-8) << aside << ", " << way.z;
    }
  }
}

TEST(Carve, ATurnOnALongMoveIsWorkOnlyWhereTheToolPasses) {
  // A million radii and half a turn, of which the tool spends a millionth near the block.
  const double r = 1.5e-3;
  const Vec3 middle(0.008, 0.006, 0.006), way(1500, 900, 600);
  const std::vector<Pose> poses{{middle - 0.5 * way, glm::normalize(Vec3(1, 0.2, 0.1))},
                                {middle + 0.5 * way, glm::normalize(Vec3(-1, 0.3, 0.5))}};
  Volume volume = Volume::block({{{0, 0, 0}, {0.016, 0.012, 0.012}}, 5e-4, "xyz"});
  CarveOptions options;
  options.tolerance = r / 50;
  const Cut cut = carve(volume, cutters::ball(2 * r, 2 * r), poses, options);
  EXPECT_GT(cut.removed[0], 0);
  EXPECT_LT(volume.take_stats().hits, 20000U);
}

TEST(Carve, APieceThatCannotReachLeavesItsNeighbourBounded) {
  // The shank stays below the block, the cone above it does not: as it moves up, rays enter through the shank.
  const Tool tool = cutters::profile(
      {{{0.49131754498843011, 0.40722570406334546}, Vec2(0, 0.5)}, {{3, 13.692798960188219}, {}}}, 35.017852589786258);
  const Vec3 axis(-0.87353197686686335, -0.22275330595436235, -0.43280809844256862);
  const std::vector<Pose> poses{{{-129.74732872570448, 0.23872157529847637, 4.6778759650988686}, axis},
                                {{342.90258616541985, 20.897766697430594, -2.786077251926657}, axis}};
  Volume volume = Volume::block({{{0, 0, 0}, {16, 8, 15}}, 0.5, "z"});
  carve(volume, tool, poses);
  const reference::SweptDistance distance(tool.profile(), Motion(poses[0], poses[1]));
  const dexel::Grid& grid = volume.reference();
  int ends = 0;
  for (int i = 0; i < grid.nu(); ++i)
    for (int j = 0; j < grid.nv(); ++j)
      for (const dexel::Span& span : grid.ray(i, j))
        for (const double s : {span.near, span.far}) {
          if (s == grid.box().lower.z || s == grid.box().upper.z) continue;
          EXPECT_LT(std::abs(distance({grid.u(i), grid.v(j), s})), 1e-8) << i << ", " << j;
          ++ends;
        }
  EXPECT_GT(ends, 200);
}

/// Rays leave the tool through its rounded end, above the block.
TEST(Carve, ARoundedEndAboveTheBlockBoundsTheShankBelow) {
  const Tool tool = cutters::fillet(6.8053684546226449, 0.42533552841391531, 85.861101581421934);
  const Vec3 axis{0.35767547507862152, 0.063208296424172861, -0.93170433389055152};
  const std::vector<Pose> poses{{{-67.6212, -36.8546, 115.2503}, axis}, {{97.3713, 70.7177, -91.0794}, axis}};
  const reference::SweptDistance distance(tool.profile(), Motion(poses[0], poses[1]));
  int ends = 0;
  for (const double top : {18.0, 22.0, 26.0, 28.5, 30.0, 32.0, 34.0, 38.0, 46.0}) {
    Volume volume = Volume::block({{{-8, -2, -4}, {2, 8, top}}, 1, "z"});
    carve(volume, tool, poses);
    const dexel::Grid& grid = volume.reference();
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        for (const dexel::Span& span : grid.ray(i, j))
          for (const double s : {span.near, span.far}) {
            const double off = distance({grid.u(i), grid.v(j), s});
            EXPECT_GT(off, -1e-8) << i << ", " << j << " below " << top;
            if (s == grid.box().lower.z || s == grid.box().upper.z) continue;
            EXPECT_LT(off, 1e-8) << i << ", " << j << " below " << top;
            ++ends;
          }
  }
  EXPECT_GT(ends, 200);
}

TEST(Carve, ATurningToolThatGrazesARayAllAlongDoesNotCombIt) {
  // Turning about y leaves the disc's reach along y unchanged; chords are 5e-5 mm, one after the other for 90 mm.
  const double h = 0.5, beside = 3 - 1e-10;
  Volume volume = Volume::block({{{0, 0, 0}, {100, 8, 4}}, h, "x"});
  const dexel::Grid& grid = volume.grids()[0];
  const double y = to_world(grid.axis(), {grid.shifted_u(8), grid.shifted_v(4), 0}).y;
  const std::vector<Pose> poses{{{5, y - beside, 1}, {0, 0, 1}},
                                {{95, y - beside, 1}, glm::normalize(Vec3(0.2, 0, 1))}};
  CarveOptions options;
  options.tolerance = 1e-3;
  carve(volume, cutters::flat(6, 3), poses, options);
  EXPECT_GT(volume.take_stats().rays_changed, 50U);
  EXPECT_LT(volume.grids()[0].span_count(), 1000U);
}

TEST(SweptNormal, IsTheGradientOfTheDistance) {
  const double tilt = 0.3;
  const Vec3 upright(0, 0, 1), leaning(std::sin(tilt), 0, std::cos(tilt));
  const std::vector<std::vector<Pose>> moves = {{{{6, 10, 7}, upright}, {{14, 11, 6}, upright}},
                                                {{{6, 10, 7}, leaning}, {{14, 11, 7}, leaning}},
                                                {{{10, 10, 9}, leaning}, {{10, 10, 5}, leaning}},
                                                {{{6, 10, 7}, upright}, {{14, 10, 6}, leaning}}};
  int number = 0;
  for (const Tool& tool : {cutters::ball(6, 30), cutters::flat(6, 30), cutters::fillet(8, 1, 30),
                           cutters::taper(0.5, 0.2, 8, 40), cutters::cone_end(1.0, 1, 0.4, 8, 40), waisted()})
    for (const std::vector<Pose>& poses : moves) {
      if (test::kSanitized && number++ % 3 != 0) continue;  // each tool and each move once or twice
      const reference::SweptDistance distance(tool.profile(), Motion(poses[0], poses[1]));
      Volume volume = Volume::block({{{0, 0, 0}, {20, 20, 12}}, 0.8, "xyz"});
      CarveOptions options;
      options.tolerance = 1e-5;
      carve(volume, tool, poses, options);
      int seen = 0, edges = 0, wrong = 0;
      for (const dexel::Grid& grid : volume.grids())
        for (int i = 0; i < grid.nu(); ++i)
          for (int j = 0; j < grid.nv(); ++j) {
            const auto ray = grid.ray(i, j);
            for (std::size_t k = 0; k < ray.size(); ++k)
              for (const bool near : {true, false}) {
                const double end = near ? ray[k].near : ray[k].far;
                const Vec3 p = to_world(grid.axis(), {grid.u(i), grid.v(j), end});
                const bool own = end == grid.box().lower.z || end == grid.box().upper.z;
                if (own || std::abs(distance(p)) > 2e-5) continue;  // not of the cut
                Vec3 gradient;
                for (int c = 0; c < 3; ++c) {
                  Vec3 step(0);
                  step[c] = 2e-3;
                  gradient[c] = (distance(p + step) - distance(p - step)) / 4e-3;
                }
                // On an edge the differences lie on both of its sides.
                if (std::abs(glm::length(gradient) - 1) > 1e-3) {
                  ++edges;
                  continue;
                }
                const dexel::PackedNormal& packed =
                    near ? grid.ray_normals(i, j)[k].near : grid.ray_normals(i, j)[k].far;
                ++seen, wrong += glm::length(packed.unpack() + gradient) > 0.02;
              }
          }
      EXPECT_GT(seen, 50) << tool.kind();
      EXPECT_LT(edges, seen / 2) << tool.kind();
      EXPECT_EQ(wrong, 0) << tool.kind() << ", move " << &poses - moves.data() << ", of " << seen;
    }
}

}  // namespace
}  // namespace riffler::sweep::steps_test
