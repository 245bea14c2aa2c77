#include "riffler/plan/cutter_locations.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "geom/directions.hpp"
#include "mesh/shapes.hpp"
#include "riffler/plan/least_tilt.hpp"
#include "riffler/plan/orientation.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::plan::cutter_locations_test {
namespace {

const Vec3 kUp(0, 0, 1);

/// A floor at z = 0 and a wall at x = 0, `height` high, both 40 mm along y; the ball's path in their corner.
struct Corner {
  Mesh part;
  PencilPath path;
};
Corner corner(double radius, double height, int points) {
  Corner out{both(mesh::box_mesh({0, -20, -5}, {30, 20, 0}), mesh::box_mesh({-10, -20, -5}, {0, 20, height})), {}};
  out.path.radius = radius;
  for (int k = 0; k < points; ++k) {
    const double y = -10 + 20.0 * k / (points - 1);
    out.path.centres.emplace_back(radius, y, radius);
    out.path.contacts.push_back({Vec3(radius, y, 0), Vec3(0, y, radius)});
    out.path.normals.push_back({kUp, Vec3(1, 0, 0)});
  }
  return out;
}

TEST(CutterLocations, OfAFreeCornerAreTheBallsPath) {
  const Corner c = corner(3, 10, 5);
  const Vec3 axis = glm::normalize(Vec3(0.5, 0, 1));
  const PencilPath path = oriented(c.path, {{0, axis}}, Interpolation::Smooth);
  const CutterLocations found =
      cutter_locations(path, collide::Assembly(cutters::ball(6, 30)), collide::Collider(c.part), {});
  EXPECT_TRUE(found.good());
  ASSERT_EQ(found.rows.size(), 5U);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(found.rows[k].pose.tip, path.centres[k] - 3.0 * axis);
    EXPECT_EQ(found.rows[k].lift, 0);
    EXPECT_EQ(found.rows[k].point, static_cast<std::ptrdiff_t>(k));
  }
  EXPECT_GE(found.bound, -0.01);
}

TEST(CutterLocations, OfALoopEndWithItsFirstRow) {
  Corner c = corner(3, 10, 3);
  c.path.closed = true;
  const PencilPath path = oriented(c.path, {{0, kUp}}, Interpolation::Smooth);
  LocationRule rule;
  rule.tolerance = 0.5;
  const CutterLocations found =
      cutter_locations(path, collide::Assembly(cutters::ball(6, 30)), collide::Collider(c.part), rule);
  ASSERT_EQ(found.rows.size(), 4U);
  EXPECT_EQ(found.rows.back().pose.tip, found.rows.front().pose.tip);
}

TEST(CutterLocations, AreInsertedWhereTheMotionGouges) {
  // A post stands in the corner half way between two points of the path.
  Corner c = corner(3, 10, 2);
  c.part = both(c.part, mesh::box_mesh({2.5, -0.5, -1}, {3.5, 0.5, 2}));
  const collide::Assembly ball(cutters::ball(6, 30));
  const PencilPath path = oriented(c.path, {{0, glm::normalize(Vec3(0.5, 0, 1))}}, Interpolation::Smooth);
  LocationRule rule;
  rule.tolerance = 0.2;
  const collide::Collider collider(c.part);
  const CutterLocations found = cutter_locations(path, ball, collider, rule);
  EXPECT_TRUE(found.good());
  EXPECT_GT(found.rows.size(), 3U);
  EXPECT_GE(found.bound, -0.2);
  // Densely, by the clearance itself.
  for (std::size_t k = 0; k + 1 < found.rows.size(); ++k)
    for (int i = 0; i <= 20; ++i)
      ASSERT_GT(collider.clearance(ball, Motion(found.rows[k].pose, found.rows[k + 1].pose).at(i / 20.0)), -0.203);
  rule.max_inserted = 0;
  const CutterLocations refused = cutter_locations(path, ball, collider, rule);
  EXPECT_FALSE(refused.good());
  ASSERT_EQ(refused.unsafe.size(), 1U);
  EXPECT_EQ(refused.unsafe[0].row, 0U);
  EXPECT_LT(refused.unsafe[0].clearance, -0.2);
}

TEST(CutterLocations, OmitPointsThatNoLiftFreesWithTheReason) {
  const Corner c = corner(3, 10, 3);
  const Mesh roof = both(c.part, mesh::box_mesh({-10, -20, 15}, {30, 20, 20}));
  const PencilPath path = oriented(c.path, {{0, kUp}}, Interpolation::Smooth);
  LocationRule rule;
  rule.max_lift = 4;
  const CutterLocations found =
      cutter_locations(path, collide::Assembly(cutters::ball(6, 30)), collide::Collider(roof), rule);
  EXPECT_FALSE(found.good());
  EXPECT_TRUE(found.rows.empty());
  ASSERT_EQ(found.blocked.size(), 3U);
  EXPECT_EQ(found.blocked[1].point, 1U);
  EXPECT_NE(found.blocked[1].reason.find("the cutter meets the part"), std::string::npos) << found.blocked[1].reason;
}

TEST(CutterLocations, RefuseAPathWithoutAxesAndInvalidSettings) {
  const Corner c = corner(3, 10, 2);
  const collide::Collider collider(c.part);
  const collide::Assembly ball(cutters::ball(6, 30));
  EXPECT_THROW(cutter_locations(c.path, ball, collider, {}), std::invalid_argument);
  const PencilPath path = oriented(c.path, {{0, kUp}}, Interpolation::Slerp);
  for (const auto& spoil : std::initializer_list<std::function<void(LocationRule&)>>{
           [](LocationRule& r) { r.tolerance = 0; }, [](LocationRule& r) { r.clearance = std::nan(""); },
           [](LocationRule& r) { r.max_lift = -1; }, [](LocationRule& r) { r.max_inserted = -1; }}) {
    LocationRule rule;
    spoil(rule);
    EXPECT_THROW(cutter_locations(path, ball, collider, rule), std::invalid_argument);
  }
}

MapRule coarse() {
  MapRule rule;
  for (int i = -4; i <= 4; ++i) rule.inclinations.push_back(0.3 * i), rule.tilts.push_back(0.3 * i);
  return rule;
}

TEST(OrientationMap, InACornerIsTheQuadrantBetweenTheWalls) {
  // Long thin ball cutter in the corner of two walls: an axis is free where it leaves both walls, in closed form.
  const Corner c = corner(3, 60, 3);
  const Tool tool = cutters::ball(6, 30);
  const MapRule rule = coarse();
  const OrientationMap map = orientation_maps(c.path, {1}, collide::Assembly(tool), collide::Collider(c.part), rule)[0];
  EXPECT_LT(glm::length(map.frame.x - Vec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::length(map.frame.z - glm::normalize(Vec3(1, 0, 1))), 1e-12);
  for (std::size_t i = 0; i < map.axes.size(); ++i) {
    const Vec3& a = map.axes[i];
    if (std::abs(a.y) * 30 > 7) continue;  // beyond the walls' ends the closed form is another one
    const double out = std::min({0.0, 27 * a.x, 27 * a.z});
    if (out == 0) {
      EXPECT_EQ(map.state[i], OrientationMap::State::Free) << i;
    } else if (out < -0.1) {
      EXPECT_EQ(map.state[i], OrientationMap::State::Blocked) << i;
    }
  }
  ASSERT_TRUE(map.least_tilt().has_value());
  EXPECT_LT(glm::length(map.axes[*map.least_tilt()] - map.frame.z), 1e-12);
  EXPECT_EQ(map.why_none(), "");
}

TEST(OrientationMap, ComputesNothingBeyondTheMachinesCone) {
  const Corner c = corner(3, 60, 3);
  MapRule rule = coarse();
  rule.limit = AxisLimit{kUp, 0.5};
  const OrientationMap map =
      orientation_maps(c.path, {1}, collide::Assembly(cutters::ball(6, 30)), collide::Collider(c.part), rule)[0];
  for (std::size_t i = 0; i < map.axes.size(); ++i) {
    EXPECT_EQ(map.state[i] == OrientationMap::State::Beyond, geom::angle_between(map.axes[i], kUp) > 0.5 + 1e-12);
    EXPECT_EQ(std::isnan(map.clearance[i]), map.state[i] == OrientationMap::State::Beyond);
  }
}

TEST(OrientationMap, NamesTheObstacleIfNothingIsFree) {
  const Corner c = corner(3, 10, 3);
  // A lid 5 mm above the floor, and a ball of 6 mm under it.
  const Mesh lid = both(c.part, mesh::box_mesh({-10, -20, 5}, {30, 20, 12}));
  const OrientationMap map =
      orientation_maps(c.path, {1}, collide::Assembly(cutters::ball(6, 20)), collide::Collider(lid), coarse())[0];
  EXPECT_FALSE(map.least_tilt().has_value());
  EXPECT_EQ(map.why_none().find("the cutter enters the part with every axis, at best by "), 0U) << map.why_none();
}

TEST(LeastTilt, LeansJustAsFarAsAWallRequires) {
  // A post next to the middle of the path: leaning away from it there, upright (as far as free) at the ends.
  const Corner c = corner(3, 4, 9);
  TiltRule rule;
  rule.map = coarse();
  rule.max_change = 0.7;
  const collide::Assembly ball(cutters::ball(6, 30));
  const TiltAnswer answer = least_tilt(c.path, ball, collide::Collider(c.part), rule);
  ASSERT_TRUE(answer.found) << answer.reason;
  for (const double angle : answer.angles) EXPECT_LT(angle, 1e-12) << "the bisector is free";
  EXPECT_LT(answer.cost, 1e-20);
  const Mesh post = both(c.part, mesh::box_mesh({10, -1, 8}, {40, 1, 40}));
  const TiltAnswer around = least_tilt(c.path, ball, collide::Collider(post), rule);
  ASSERT_TRUE(around.found) << around.reason;
  EXPECT_GT(around.angles[4], 0.1);
  for (std::size_t k = 1; k < around.axes.size(); ++k)
    EXPECT_LE(geom::angle_between(around.axes[k - 1], around.axes[k]), 0.7 + 1e-9);
  PencilPath loop = c.path;
  loop.closed = true;
  const TiltAnswer round = least_tilt(loop, ball, collide::Collider(post), rule);
  ASSERT_TRUE(round.found) << round.reason;
  EXPECT_LE(geom::angle_between(round.axes.front(), round.axes.back()), 0.7 + 1e-9);
}

TEST(LeastTilt, NamesTheFirstUnreachablePoint) {
  const Corner c = corner(3, 10, 5);
  TiltRule rule;
  rule.map = coarse();
  const Mesh lid = both(c.part, mesh::box_mesh({-10, -4, 5}, {30, 20, 12}));
  const TiltAnswer answer = least_tilt(c.path, collide::Assembly(cutters::ball(6, 20)), collide::Collider(lid), rule);
  EXPECT_FALSE(answer.found);
  EXPECT_GT(answer.point, 0U);
  EXPECT_NE(answer.reason.find("no orientation is free"), std::string::npos) << answer.reason;
}

TEST(CutterLocations, AbsurdTolerancesAreRefusedAndLongMotionsCanBeCancelled) {
  const Corner c = corner(3, 30, 3);
  const PencilPath path = oriented(c.path, {{0, glm::normalize(Vec3(-0.6, 0, 1))}}, Interpolation::Smooth);
  LocationRule rule;
  rule.tolerance = 1e-9;
  EXPECT_THROW(cutter_locations(path, collide::Assembly(cutters::ball(6, 30)), collide::Collider(c.part), rule),
               std::invalid_argument);
  rule.tolerance = 1e-6;
  rule.max_inserted = 1 << 30;
  EXPECT_THROW(cutter_locations(path, collide::Assembly(cutters::ball(6, 30)), collide::Collider(c.part), rule),
               std::invalid_argument);
}

}  // namespace
}  // namespace riffler::plan::cutter_locations_test
