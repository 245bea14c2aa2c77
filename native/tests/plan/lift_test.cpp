#include "riffler/plan/lift.hpp"

#include <gtest/gtest.h>

#include "cutters.hpp"
#include "mesh/shapes.hpp"
#include "plan/point_lift.hpp"
#include "reference/cutter_distance.hpp"
#include "riffler/plan/contact_location.hpp"
#include "stress/random.hpp"
#include "support/effort.hpp"

namespace riffler::plan::lift_test {
namespace {

const Vec3 kUp(0, 0, 1);

TEST(OffsetToolColumns, EndAtTheGivenDistance) {
  stress::Random random(1);
  for (const Tool& cutter : named_cutters()) {
    const Tool tool = cutter.with_shank({{cutter.length(), 3, cutter.length() + 10, 5}})
                          .with_holder({{cutter.length() + 10, 12, cutter.length() + 30, 9}});
    SCOPED_TRACE(tool.name());
    const tool::Outline outline(tool);
    for (int n = 0; n < 2000; ++n) {
      const double c = n % 3 ? random.uniform(-0.5, 2) : 0;
      const OffsetToolColumns columns(outline, c);
      const double rho = n % 10 ? random.uniform(0, 14) : 0, z = random.uniform(-2, cutter.length() + 32);
      const double here = outline.nearest(rho, z).distance;
      const OffsetToolColumns::Column column = columns.at(rho, z);
      ASSERT_EQ(column.covered, here < c);
      if (!column.covered) continue;
      EXPECT_NEAR(outline.nearest(rho, column.low).distance, c, 1e-7);
      EXPECT_NEAR(outline.nearest(rho, column.high).distance, c, 1e-7);
      for (int i = 1; i < 200; ++i)
        ASSERT_LT(outline.nearest(rho, glm::mix(column.low, column.high, i / 200.0)).distance, c + 1e-9);
    }
  }
}

/// From z = 0 down, as large as asked.
Mesh plate(double size) {
  return mesh::box_mesh({-size, -size, -5}, {size, size, 0});
}

TEST(Lift, IsNothingWhereTheToolIsFreeOrTouches) {
  const collide::Collider collider(plate(50));
  const collide::Assembly ball(cutters::ball(6, 30));
  for (const double z : {0.0, 1e-9, 4.0}) {
    const Lift l = lift(collider, ball, {{1, 2, z}, kUp}, {});
    EXPECT_TRUE(l.free);
    EXPECT_EQ(l.height, 0);
    EXPECT_EQ(l.evaluations, 1);
    EXPECT_NEAR(l.before, z, 1e-12);
  }
}

TEST(Lift, FromAPlateIsTheDepthOverTheCosine) {
  const collide::Collider collider(plate(50));
  const collide::Assembly ball(cutters::ball(6, 30));
  for (const double angle : {0.0, 0.3, 1.0, 1.4})
    for (const double depth : {1e-4, 0.01, 0.5, 2.0})
      for (const double clearance : {0.0, 0.7, -5e-5}) {
        const Vec3 axis(std::sin(angle), 0, std::cos(angle));
        const Lift l = lift(collider, ball, {Vec3(0, 0, 3 - depth) - 3.0 * axis, axis}, {clearance});
        EXPECT_TRUE(l.free);
        EXPECT_NEAR(l.height, (depth + clearance) / std::cos(angle), 1e-5) << angle << " " << depth;
        EXPECT_LT(l.evaluations, 25) << angle << " " << depth << " " << clearance;
        EXPECT_EQ(l.touch, collide::Touch::Cutter);
      }
}

TEST(Lift, AlongAnUprightWallIsItsHeightInFewSteps) {
  // The tool's side is 1e-4, 0.01 or 1 mm in a wall whose top is at z = 40; the tip starts at 0.
  for (const double depth : {2e-6, 1e-4, 0.01, 1.0})
    for (const int times : {0, 3}) {
      const Mesh wall = subdivided(mesh::box_mesh({0, -30, -10}, {10, 30, 40}), times);
      const collide::Collider collider(wall);
      const Lift l = lift(collider, collide::Assembly(cutters::flat(6, 20)), {{-3 + depth, 0.1, 0}, kUp}, {});
      EXPECT_TRUE(l.free);
      EXPECT_NEAR(l.height, 40, 1e-6) << depth;
      EXPECT_LT(l.evaluations, 40) << depth << " " << times;
      const Lift b = lift(collider, collide::Assembly(cutters::ball(6, 20)), {{-3 + depth, 0.1, 0}, kUp}, {});
      EXPECT_NEAR(b.height, 40 - (3 - std::sqrt(9 - (3 - depth) * (3 - depth))), 1e-5) << depth;
      EXPECT_LT(b.evaluations, 60) << depth << " " << times;
    }
}

TEST(Lift, StopsInTheFirstFreePlaceUnderARoof) {
  // Free between z = 0 and a roof at 12: the flat cutter of length 5, sunk 1 mm, fits between.
  const Mesh part = both(plate(20), mesh::box_mesh({-20, -20, 12}, {20, 20, 15}));
  const collide::Collider collider(part);
  const collide::Assembly stub(cutters::flat(6, 5));
  const Lift l = lift(collider, stub, {{0, 0, -1}, kUp}, {});
  EXPECT_TRUE(l.free);
  EXPECT_NEAR(l.height, 1, 1e-6);
  // 13 mm long it does not fit, and comes out above the roof; within 10 mm it does not, which is reported.
  const collide::Assembly longer(cutters::flat(6, 13));
  const Lift over = lift(collider, longer, {{0, 0, -1}, kUp}, {});
  EXPECT_TRUE(over.free);
  EXPECT_NEAR(over.height, 16, 1e-6);
  const Lift stuck = lift(collider, longer, {{0, 0, -1}, kUp}, {0, 1e-6, 10});
  EXPECT_FALSE(stuck.free);
  EXPECT_GT(stuck.height, 10);
}

TEST(Lift, IntoTheMaterialFreesNothing) {
  // A cutter of 5 mm under a block 40 mm thick: above its lower face nothing of the surface is near.
  const collide::Collider collider(both(plate(20), mesh::box_mesh({-20, -20, 4}, {20, 20, 44})));
  const Lift l = lift(collider, collide::Assembly(cutters::flat(6, 5)), {{0, 0, -1}, kUp}, {});
  EXPECT_FALSE(l.free);
  EXPECT_TRUE(l.swallowed);
  EXPECT_TRUE(lift(collider, collide::Assembly(cutters::flat(6, 3)), {{0, 0, -1}, kUp}, {}).free);
}

TEST(Lift, OfAToolThatStandsInTheMaterialIsNotFreeThoughItTouchesNothing) {
  const collide::Collider block(mesh::box_mesh({-20, -20, 0}, {20, 20, 40}));
  const Lift l = lift(block, collide::Assembly(cutters::flat(6, 5)), {{0, 0, 15}, kUp}, {});
  EXPECT_GT(l.before, 0);
  EXPECT_FALSE(l.free);
  EXPECT_TRUE(l.swallowed);
  EXPECT_EQ(l.height, 0);
}

TEST(Lift, InABowlThatIsOpenAboveIsFree) {
  // The bowl surrounds the tool on more than half of all sides, but with its normals towards it.
  Mesh bowl = mesh::box_mesh({-20, -20, 0}, {20, 20, 40});
  std::erase_if(bowl.triangles, [&](const Vec3i& t) {
    return bowl.vertices[t.x].z > 1 && bowl.vertices[t.y].z > 1 && bowl.vertices[t.z].z > 1;
  });
  for (Vec3i& t : bowl.triangles) std::swap(t.y, t.z);
  const Lift l = lift(collide::Collider(bowl), collide::Assembly(cutters::flat(6, 5)), {{0, 0, 2}, kUp}, {});
  EXPECT_TRUE(l.free);
  EXPECT_EQ(l.height, 0);
}

TEST(Lift, NamesTheCollidingPiece) {
  const Mesh wall = mesh::box_mesh({10, -30, -10}, {20, 30, 25});
  const Tool tool = cutters::ball(6, 20).with_shank({{20, 3, 30, 3}}).with_holder({{30, 12, 60, 12}});
  const Lift l = lift(collide::Collider(both(plate(8), wall)), collide::Assembly(tool), {{0, 0, -7}, kUp}, {});
  EXPECT_TRUE(l.free);
  EXPECT_NEAR(l.height, 7, 1e-6);
  EXPECT_EQ(l.touch, collide::Touch::Cutter) << "the holder was free at 25 - 23 = 2 mm";
  const Lift h = lift(collide::Collider(wall), collide::Assembly(tool), {{0, 0, -7}, kUp}, {});
  EXPECT_NEAR(h.height, 2, 1e-6);
  EXPECT_EQ(h.touch, collide::Touch::Holder);
  const Volume vise = Volume::block({Box3{{10, -30, -10}, {20, 30, 25}}, 0.5, "z"});
  const Lift f = lift(collide::Collider(plate(8), {vise}), collide::Assembly(tool), {{0, 0, -1}, kUp}, {});
  EXPECT_NEAR(f.height, 1, 1e-6);
  const Lift g =
      lift(collide::Collider(moved(plate(8), {0, 0, -9}), {vise}), collide::Assembly(tool), {{0, 0, -7}, kUp}, {});
  EXPECT_TRUE(g.free);
  EXPECT_NEAR(g.height, 2, 0.3);
  EXPECT_EQ(g.touch, collide::Touch::Fixture);
}

/// Over rolling hills, at dense points: against the cutter by the independent reference.
TEST(Lift, IsTheLeastFreeHeightOfADenseSearch) {
  const Mesh hills =
      mesh::sheet_mesh(12, 30, [](double x, double y) { return 2 * std::sin(0.5 * x) * std::cos(0.4 * y); });
  const Mesh dense = subdivided(hills, 4);
  const collide::Collider collider(hills);
  stress::Random random(8);
  for (const Tool& tool : named_cutters()) {
    SCOPED_TRACE(tool.name());
    const reference::CutterDistance reference(tool.profile());
    const collide::Assembly assembly(tool);
    for (int n = 0; n < test::cases(2); ++n) {
      const Pose pose{{random.uniform(8, 22), random.uniform(8, 22), random.uniform(-3, 0)},
                      glm::normalize(Vec3(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), 1))};
      const Lift l = lift(collider, assembly, pose, {});
      ASSERT_TRUE(l.free);
      const auto least_at = [&](double h) {
        double least = 1e9;
        for (const Vec3& v : dense.vertices) {
          const Vec3 d = v - pose.tip - h * pose.axis;
          least = std::min(least, reference.distance(glm::length(glm::cross(d, pose.axis)), glm::dot(d, pose.axis)));
        }
        return least;
      };
      EXPECT_GT(least_at(l.height), -3e-3) << n;
      for (double h = 0; h < l.height - 0.1; h += test::kSanitized ? 0.3 : 0.05)
        EXPECT_LT(least_at(h), 0.05) << n << " " << h << " " << l.height;
    }
  }
}

TEST(Lift, IsTheSameFarFromTheOriginAndFromTrianglesWithoutArea) {
  Mesh part = plate(20);
  part.triangles.emplace_back(4, 4, 5), part.triangles.emplace_back(6, 6, 6);
  const Vec3 far(1e5, -1e5, 1e5), axis = glm::normalize(Vec3(0.3, -0.2, 1));
  const collide::Collider at_hand(part), away(moved(part, far));
  const Pose pose{{1, 2, -1.5}, axis};
  for (const Tool& tool : named_cutters()) {
    const Lift here = lift(at_hand, collide::Assembly(tool), pose, {}),
               there = lift(away, collide::Assembly(tool), {pose.tip + far, axis}, {});
    ASSERT_TRUE(here.free && there.free) << tool.name();
    EXPECT_NEAR(here.height, there.height, 1e-8) << tool.name();
    // Only the plate's top is near: the lift is in closed form by the cutter's lowest point.
    const CutterSupport cutter(tool);
    const Vec2 low = cutter.point({std::sqrt(1 - axis.z * axis.z), -axis.z});
    EXPECT_NEAR(here.height, (1.5 + low.x * std::sqrt(1 - axis.z * axis.z) - low.y * axis.z) / axis.z, 1e-7)
        << tool.name();
  }
}

TEST(Lift, RefusesInvalidSettings) {
  const collide::Collider collider(plate(5));
  const collide::Assembly ball(cutters::ball(6, 30));
  EXPECT_THROW(lift(collider, ball, {}, {std::nan("")}), std::invalid_argument);
  EXPECT_THROW(lift(collider, ball, {}, {0, 0}), std::invalid_argument);
  EXPECT_THROW(lift(collider, ball, {}, {0, 1e-6, -1}), std::invalid_argument);
  EXPECT_THROW(lift(collider, ball, {}, {0, 1e-6, 1, 0}), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::plan::lift_test
