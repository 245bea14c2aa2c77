#include "riffler/plan/cut_along.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "geom/directions.hpp"
#include "mesh/shapes.hpp"
#include "plan/pose_leads.hpp"
#include "plan/row_axes.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/random.hpp"

namespace riffler::plan::cut_along_test {
namespace {

const Vec3 kUp(0, 0, 1);

Tool held() {
  return cutters::ball(6, 20).with_shank({{20, 2.5, 30, 2.5}}).with_holder({{30, 9, 50, 12}});
}

TEST(DepthBelowTip, IsThatOfTheLowestPointOrALittleMore) {
  for (const double tilt : {0.0, 0.3, 0.8, 1.3}) {
    double lowest = 0;
    const auto ring = [&](double r, double z) { lowest = std::max(lowest, r * std::sin(tilt) - z * std::cos(tilt)); };
    for (int k = 0; k <= 100; ++k) ring(3 * std::sin(0.0157 * k), 3 - 3 * std::cos(0.0157 * k));
    ring(3, 20), ring(2.5, 20), ring(9, 30), ring(12, 50);
    const double found = depth_below_tip(held(), tilt);
    EXPECT_GE(found, lowest - 1e-9);
    EXPECT_LE(found, lowest + 3);  // the ball's box
  }
}

TEST(PoseLeads, ComesFromTheSideWhereTheAxisIsBlocked) {
  // A roof 15 mm above a plate, which ends at x = 0.
  Mesh part = mesh::box_mesh({-20, -20, -5}, {20, 20, 0});
  const Mesh roof = mesh::box_mesh({-20, -20, 15}, {0, 20, 20});
  const int base = static_cast<int>(part.vertices.size());
  part.vertices.insert(part.vertices.end(), roof.vertices.begin(), roof.vertices.end());
  for (const Vec3i& t : roof.triangles) part.triangles.push_back(t + Vec3i(base));
  const collide::Collider collider(part);
  const Tool ball = cutters::ball(2, 6);
  const PoseLeads leads({collider, nullptr, kUp, 0, 0.01}, ball);
  const auto open = leads.find({{10, 0, 0}, kUp}, 40, true);
  ASSERT_TRUE(open);
  EXPECT_EQ(open->top, Vec3(10, 0, 40));
  const auto aside = leads.find({{-3, 0, 0}, kUp}, 40, true);
  ASSERT_TRUE(aside);
  EXPECT_GT(aside->top.x, 10);
  EXPECT_FALSE(leads.find({{-15, 0, 0}, kUp}, 40, true));
}

TEST(RowAxes, TurnNoFasterThanAllowedAndKeepTheCentreOnItsLine) {
  // A ridge with a roof of 90°: the normal jumps by a right angle.
  const Mesh part = {{{-20, -20, 0}, {0, -20, 20}, {20, -20, 0}, {-20, 20, 0}, {0, 20, 20}, {20, 20, 0}},
                     {{0, 2, 1}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}, {0, 3, 5}, {0, 5, 2}}};
  const Tool tool = held();
  const collide::Assembly assembly(tool);
  const collide::Collider collider(part);
  const double tolerance = 0.01;
  for (const double most : {0.05, 0.3}) {
    AxisRule rule;
    rule.max_turn = most;
    const RowAxes axes(rule, part, kUp, assembly, collider, 0, tolerance);
    std::vector<Vec3> line;
    const double off = 3 / std::sqrt(2.0);
    line.push_back({-15 - off, 0, 5 + off}), line.push_back({-off, 0, 20 + off});
    for (int k = 1; k < 8; ++k) {
      const double turn = -0.7853981633974483 + k * 0.19634954084936207;
      line.push_back({3 * std::sin(turn), 0, 20 + 3 * std::cos(turn)});
    }
    line.push_back({off, 0, 20 + off}), line.push_back({15 + off, 0, 5 + off});
    const CutLine found = axes(line, std::vector<MoveKind>(line.size(), MoveKind::Cut));
    ASSERT_GT(found.poses.size(), line.size());
    double along = 0;
    for (std::size_t k = 1; k < found.poses.size(); ++k) {
      const Motion motion(found.poses[k - 1], found.poses[k]);
      const auto centre = [&](double t) { return motion.tip(t) + 3.0 * motion.axis(t); };
      const double way = glm::length(centre(1) - centre(0));
      along += way;
      EXPECT_LE(motion.angle(), most * way + 1e-6);
      EXPECT_LE(glm::length(centre(0.5) - 0.5 * (centre(0) + centre(1))), 0.25 * tolerance + 1e-9);
    }
    EXPECT_GT(along, 40);
    if (most < 0.1) continue;  // the line is too short for a right angle
    EXPECT_LT(geom::angle_between(found.poses.front().axis, glm::normalize(Vec3(-1, 0, 1))), 1e-6);
    EXPECT_LT(geom::angle_between(found.poses.back().axis, glm::normalize(Vec3(1, 0, 1))), 1e-6);
  }
}

TEST(CutAlong, NamesLineAndPoseOfWrongInput) {
  const SetupScene scene{
      mesh::box_mesh({-20, -20, -5}, {20, 20, 0}), {}, Volume::block({{{-20, -20, -5}, {20, 20, 1}}, 1, "xyz"})};
  const auto refused = [&](std::vector<Pose> poses) {
    try {
      cut_along(scene, held(), {{{{{0, 0, 0}, kUp}, {{1, 0, 0}, kUp}}}, {std::move(poses)}}, {});
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused({{{0, 0, 0}, kUp}}).find("line 1 has fewer than two poses"), std::string::npos);
  EXPECT_NE(refused({{{0, 0, 0}, kUp}, {{0, NAN, 0}, kUp}}).find("line 1, pose 1 is not finite"), std::string::npos);
  EXPECT_NE(refused({{{0, 0, 0}, kUp}, {{1, 0, 0}, {1, 0, 0}}}).find("line 1, pose 1: the tool leans"),
            std::string::npos);
}

TEST(CutAlong, DividesALineAtAPostAndListsIt) {
  Mesh part = mesh::box_mesh({-20, -20, -5}, {20, 20, 0});
  const SetupScene scene{
      part, {mesh::box_mesh({-2, -2, 0}, {2, 2, 10})}, Volume::block({{{-20, -20, -5}, {20, 20, 0}}, 1, "xyz"})};
  std::vector<Pose> poses;
  for (int k = -15; k <= 15; ++k) poses.push_back({{static_cast<double>(k), 0, 0}, kUp});
  const CutAlongResult found = cut_along(scene, cutters::ball(4, 30), {{poses}}, {});
  EXPECT_EQ(found.pieces, 2U);
  ASSERT_EQ(found.blocked.size(), 1U);
  EXPECT_GE(found.blocked.front().length, 7);
  for (std::size_t k = 0; k < found.poses.size(); ++k)
    if (found.kinds[k] == MoveKind::Cut) {
      EXPECT_GE(std::abs(found.poses[k].tip.x), 4 - 0.2);
    }
  EXPECT_EQ(found.kinds.front(), MoveKind::Rapid);
  EXPECT_GE(found.poses.back().tip.z, 15);
}

TEST(CutAlong, EndsAtFixturesWhoseDistanceIsNotThatOfThePart) {
  // One millimetre deep in the part, through a post, and inside a block that holds the whole tool.
  const SetupScene scene{mesh::box_mesh({-20, -20, -5}, {20, 20, 0}),
                         {mesh::box_mesh({-2, -2, 0}, {2, 2, 10}), mesh::box_mesh({-20, 8, 0}, {20, 20, 80})},
                         Volume::block({{{-20, -20, -5}, {20, 20, 0}}, 1, "xyz"})};
  CutAlongOptions options;
  options.distance = -1, options.tolerance = 0.02, options.fixture_distance = 0;
  const CutAlongResult found =
      cut_along(scene, cutters::ball(4, 30),
                {{{{{-15, 0, -1}, kUp}, {{15, 0, -1}, kUp}}}, {{{{-5, 14, 20}, kUp}, {{5, 14, 20}, kUp}}}}, options);
  EXPECT_EQ(found.pieces, 2U);
  ASSERT_EQ(found.blocked.size(), 1U);
  EXPECT_NE(found.blocked.front().reason.find("fixture"), std::string::npos);
  EXPECT_NEAR(found.blocked.front().length, 10 + 8, 1);
  double cut = 0;
  for (std::size_t k = 0; k < found.poses.size(); ++k)
    if (found.kinds[k] == MoveKind::Cut) {
      EXPECT_GE(std::abs(found.poses[k].tip.x), 4 - std::sqrt(2 * 2 * 0.02) - 1e-3);
      EXPECT_EQ(found.poses[k].tip.y, 0);
      cut += glm::length(found.poses[k].tip - found.poses[k - 1].tip);
    }
  EXPECT_NEAR(cut, 22, 1);
}

}  // namespace
}  // namespace riffler::plan::cut_along_test
