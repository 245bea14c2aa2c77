// Operations on triangles of a ball of radius 20 mm, moved onto the exact ball, against the closed form.
#include "riffler/plan/surface_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "nurbs/quadrics.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::plan::surface_fit_test {
namespace {

constexpr double kRadius = 20, kTool = 3, kOff = 0.02;
const Vec3 kUp(0, 0, 1);

collide::Collider exact_ball() {
  collide::Collider::Settings settings;
  settings.spacing = 10;
  return collide::Collider(Surface({nurbs::shapes::ball(kRadius)}), {}, settings);
}

const Tool& ball() {
  static const Tool made = tool::cutters::ball(2 * kTool, 30);
  return made;
}

/// The distance of the tool's ball from the exact one.
double gap(const Pose& pose) {
  return glm::length(pose.tip + kTool * pose.axis) - kRadius - kTool;
}

/// A pose whose ball is `off` mm from the exact one, at an angle from upright.
Pose at(double angle, double off) {
  return {(kRadius + kTool + off) * Vec3(std::sin(angle), 0, std::cos(angle)) - kTool * kUp, kUp};
}

Operation along(const std::vector<Pose>& poses, MoveKind kind = MoveKind::Cut) {
  Operation moves;
  moves.poses = poses;
  moves.kinds.assign(poses.size(), kind);
  moves.feeds.assign(poses.size(), 800);
  return moves;
}

SurfaceFitRule rule() {
  SurfaceFitRule how;
  how.tolerance = 0.004, how.deviation = kOff;
  return how;
}

TEST(SurfaceFit, PosesAndTheMovesBetweenThemAreOnTheExactBall) {
  const collide::Collider exact = exact_ball();
  std::mt19937 random(3);
  std::uniform_real_distribution<double> off(-kOff, kOff);
  std::vector<Pose> poses;
  for (int k = -20; k <= 20; ++k) poses.push_back(at(0.05 * k, off(random)));
  for (const bool level : {false, true})
    for (const double clearance : {0.0, 0.3}) {
      SCOPED_TRACE(clearance + level);
      if (test::kSanitized && level != (clearance > 0)) continue;
      Operation moves = along(poses);
      for (Pose& p : moves.poses) p.tip += clearance * glm::normalize(p.tip + kTool * kUp);
      SurfaceFitRule how = rule();
      how.level = level, how.clearance = clearance;
      const SurfaceFit fit = fit_to_surface(moves, ball(), exact, {}, how);
      ASSERT_EQ(moves.poses.size(), poses.size() + fit.inserted);
      ASSERT_EQ(moves.kinds.size(), moves.poses.size());
      ASSERT_EQ(moves.feeds.size(), moves.poses.size());
      EXPECT_EQ(fit.fitted, moves.poses.size());
      EXPECT_EQ(fit.raised + fit.kept, 0U);
      EXPECT_GT(fit.before, 0.01);
      EXPECT_GT(fit.inserted, 0U);
      double worst = 0;
      for (std::size_t k = 0; k < moves.poses.size(); ++k) {
        EXPECT_NEAR(gap(moves.poses[k]), clearance, 2e-6);
        for (int i = 1; k > 0 && i < 8; ++i) {
          const Pose between{glm::mix(moves.poses[k - 1].tip, moves.poses[k].tip, i / 8.0), kUp};
          worst = std::max(worst, std::abs(gap(between) - clearance));
        }
      }
      EXPECT_LE(worst, how.tolerance);
      EXPECT_NEAR(fit.after, worst, 2e-5);
    }
}

TEST(SurfaceFit, LeavesRapidsAndPosesThatDoNotTouchTheTriangles) {
  Operation moves = along({at(0, 1), at(0.2, 1), at(0.2, -0.01)});
  moves.kinds[2] = MoveKind::Rapid;
  const std::vector<Pose> before = moves.poses;
  const SurfaceFit fit = fit_to_surface(moves, ball(), exact_ball(), {}, rule());
  EXPECT_EQ(fit.fitted + fit.raised + fit.kept, 0U);
  ASSERT_EQ(moves.poses.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(moves.poses[k].tip, before[k].tip);
}

TEST(SurfaceFit, RaisesLeadsOutOfTheSurfaceAlongTheAxis) {
  Operation moves = along({at(0.5, 0.5), at(0.5, -0.015)}, MoveKind::Lead);
  const Vec3 before = moves.poses[1].tip;
  const SurfaceFit fit = fit_to_surface(moves, ball(), exact_ball(), {}, rule());
  EXPECT_EQ(fit.raised, 1U);
  EXPECT_EQ(fit.fitted, 0U);
  const Pose& raised = moves.poses.back();
  EXPECT_EQ(raised.tip.x, before.x);
  EXPECT_EQ(raised.tip.y, before.y);
  EXPECT_GE(gap(raised), -1e-6);
  EXPECT_LE(gap(raised), 1e-4);
}

TEST(SurfaceFit, ComesNoNearerToFixtures) {
  // A plate whose side is the plane x = 0.001 mm beyond the ball of the tool, which would move towards it.
  const Pose pose = at(1.35, kOff);
  const double side = pose.tip.x - kTool - 1e-3;
  Mesh plate;
  plate.vertices = {{side, -50, 0}, {side, 50, 0}, {side, 50, 60}, {side, -50, 60}};
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  Operation free = along({pose}), held = along({pose});
  EXPECT_EQ(fit_to_surface(free, ball(), exact_ball(), {}, rule()).fitted, 1U);
  EXPECT_NEAR(gap(free.poses[0]), 0, 2e-6);
  ASSERT_LT(free.poses[0].tip.x, pose.tip.x - 2e-3) << "it moves sideways";
  fit_to_surface(held, ball(), exact_ball(), {plate}, rule());
  EXPECT_GE(held.poses[0].tip.x, pose.tip.x - 1e-3 - 1e-6);
}

TEST(SurfaceFit, NamesTheWrongArgument) {
  Operation moves = along({at(0, 0)});
  SurfaceFitRule how = rule();
  how.clearance = -1;
  EXPECT_NE(test::error_of([&] { fit_to_surface(moves, ball(), exact_ball(), {}, how); }).find("clearance"),
            std::string::npos);
  how = rule(), how.tolerance = 0;
  EXPECT_NE(test::error_of([&] { fit_to_surface(moves, ball(), exact_ball(), {}, how); }).find("tolerance"),
            std::string::npos);
}

}  // namespace
}  // namespace riffler::plan::surface_fit_test
