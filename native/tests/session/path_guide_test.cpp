// A tool on a path: where it may stand, and how it may move.
#include "riffler/session/path_guide.hpp"

#include <gtest/gtest.h>

#include <random>

#include "geom/math.hpp"
#include "session/orient_bench.hpp"
#include "support/error_of.hpp"

namespace riffler::session::path_guide_test {
namespace {

using test::edge_path;
using test::leaning;

const Tool kBall = cutters::ball(2 * test::kBallRadius, 30);

/// A closed curve in space.
plan::PencilPath ring(int points) {
  plan::PencilPath path;
  path.radius = test::kBallRadius, path.closed = true;
  for (int k = 0; k < points; ++k) {
    const double a = kTwoPi * k / points;
    const Vec3 at(20 * std::cos(a), 20 * std::sin(a), 4 * std::sin(2 * a));
    path.centres.push_back(at);
    path.contacts.push_back({at - Vec3(0, 0, 3), at - 3.0 * Vec3(std::cos(a), std::sin(a), 0)});
    path.normals.push_back({Vec3(0, 0, 1), Vec3(std::cos(a), std::sin(a), 0)});
  }
  return path;
}

TEST(PathGuide, ABallKeepsItsCentreOnThePathForEveryAxis) {
  PathGuide guide(edge_path(), kBall, 10, leaning(0.3), false);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 200; ++k) {
    const Vec3 axis = glm::normalize(Vec3(any(random), any(random), any(random)));
    const Pose pose = guide.settled({{100 * any(random), 0, 0}, axis});
    EXPECT_EQ(pose.axis, axis);
    EXPECT_LT(glm::length(pose.tip + test::kBallRadius * axis - Vec3(12, 3, 3)), 1e-12);
    EXPECT_EQ(guide.station(), 10);
  }
}

TEST(PathGuide, ASlidingToolFindsTheNearestPlaceAndStopsAtTheEnds) {
  PathGuide guide(edge_path(), kBall, 10, leaning(0), true);
  const auto station_at = [&](const Vec3& tip) {
    guide.settled({tip, leaning(0)});
    return guide.station();
  };
  EXPECT_NEAR(station_at({13.25, 8, 5}), 11.25, 1e-12);
  EXPECT_NEAR(station_at({13.25, 8, 5}), 11.25, 1e-12);  // does not creep
  EXPECT_NEAR(station_at({12, 3, 0}), 10, 1e-12);
  EXPECT_EQ(station_at({-50, 3, 0}), 0);
  EXPECT_EQ(station_at({500, 3, 0}), 36);
  EXPECT_EQ(guide.point(), 36U);
  EXPECT_NEAR(station_at({37.5, 3, 0}), 35.5, 1e-12);
}

/// Beside a search through the whole path, in double precision and dense.
TEST(PathGuide, FollowsAHandRoundAClosedPathLikeAFullSearch) {
  const plan::PencilPath path = ring(180);
  PathGuide guide(path, kBall, 0, {0, 0, 1}, true);
  double worst = 0, turns = 0, before = 0;
  for (int k = 0; k < 1500; ++k) {
    const double a = 3 * kTwoPi * k / 1500 - 1.5 * (k > 900) * kTwoPi * (k - 900) / 1500 * 2;
    const Pose hand{{22 * std::cos(a), 22 * std::sin(a), 4 * std::sin(2 * a) - 3 + std::sin(9 * a)}, {0, 0, 1}};
    const Pose on = guide.settled(hand);
    double closest = kInfinity;
    for (std::size_t e = 0; e < path.size(); ++e)
      for (int j = 0; j < 20; ++j) {
        const Vec3 c = glm::mix(path.centres[e], path.centres[(e + 1) % path.size()], j / 20.0);
        closest = std::min(closest, glm::length(c - Vec3(0, 0, 3) - hand.tip));
      }
    worst = std::max(worst, glm::length(on.tip - hand.tip) - closest);
    ASSERT_GE(guide.station(), 0);
    ASSERT_LT(guide.station(), 180);
    turns += std::abs(guide.station() - before) > 90, before = guide.station();
  }
  EXPECT_LT(worst, 1e-3);  // the search's own steps are 0.035 mm wide
  EXPECT_GE(turns, 1);     // past the first point
}

TEST(PathGuide, ItsFreedomsAreTheDerivativesOfThePlace) {
  PathGuide guide(edge_path(), kBall, 10, leaning(0.3), true);
  haptics::Guide::Freedoms freedoms = guide.freedoms();
  for (const Twist& turn : freedoms.turns) {
    EXPECT_NEAR(glm::dot(turn.angular, leaning(0.3)), 0, 1e-12);
    const Vec3 expected = -test::kBallRadius * glm::cross(turn.angular, leaning(0.3));
    EXPECT_LT(glm::length(turn.linear - expected), 1e-7);
  }
  EXPECT_LT(glm::length(freedoms.slide.linear - Vec3(1, 0, 0)), 1e-12);
  EXPECT_GE(freedoms.back, 10);
  EXPECT_GE(freedoms.on, 10);
  guide.settled({{3.25, 3, 0}, leaning(0.3)});
  EXPECT_NEAR(guide.freedoms().back, 1.25, 1e-9);
  guide.go_to(36);
  EXPECT_EQ(guide.freedoms().on, 0);
  EXPECT_GE(guide.freedoms().back, 10);
  guide.set_slides(false);
  freedoms = guide.freedoms();
  EXPECT_EQ(freedoms.back + freedoms.on, 0);
}

/// A bull-nose cutter touches floor and wall from one side only: beyond, the tool keeps the axis that it had.
TEST(PathGuide, KeepsItsAxisWhereTheCutterCannotTouch) {
  const Tool bull = cutters::fillet(6, 1, 10);
  PathGuide guide(edge_path(), bull, 10, leaning(0.2), false);
  const Pose down = guide.settled({{12, 3, 0}, glm::normalize(Vec3(0, -0.3, -1))});
  EXPECT_TRUE(geom::finite(down.tip));
  EXPECT_NEAR(glm::length(down.axis), 1, 1e-12);
}

TEST(PathGuide, GuidesOfOnePointOrTwoEqualPointsStandStill) {
  plan::PencilPath one = edge_path();
  one.centres.resize(1), one.contacts.resize(1), one.normals.resize(1);
  PathGuide guide(one, kBall, 0, leaning(0), true);
  EXPECT_EQ(guide.settled({{50, 50, 50}, leaning(0.1)}).axis, leaning(0.1));
  EXPECT_EQ(guide.station(), 0);
  EXPECT_EQ(guide.freedoms().on, 0);
  plan::PencilPath two = edge_path();
  two.centres.resize(2), two.contacts.resize(2), two.normals.resize(2);
  two.centres[1] = two.centres[0], two.contacts[1] = two.contacts[0];
  PathGuide still(two, kBall, 0, leaning(0), true);
  EXPECT_TRUE(geom::finite(still.settled({{50, 50, 50}, leaning(0.1)}).tip));
  EXPECT_TRUE(geom::finite(still.freedoms().slide.linear));
}

TEST(PathGuide, NamesWhatItRefuses) {
  EXPECT_EQ(test::error_of([] { PathGuide({}, kBall, 0, {0, 0, 1}, true); }), "the path has no points");
  EXPECT_EQ(test::error_of([] { PathGuide(edge_path(), kBall, 37, {0, 0, 1}, true); }),
            "point 37: the path has 37, from 0");
  EXPECT_NE(test::error_of([] { PathGuide(edge_path(), kBall, 0, {0, 0, 2}, true); }), "");
  PathGuide guide(edge_path(), kBall, 4, {0, 0, 1}, true);
  EXPECT_NE(test::error_of([&] { guide.go_to(99); }), "");
  EXPECT_EQ(guide.station(), 4);
  guide.go_to(7);
  EXPECT_EQ(guide.pose().tip, Vec3(9, 3, 0));
}

}  // namespace
}  // namespace riffler::session::path_guide_test
