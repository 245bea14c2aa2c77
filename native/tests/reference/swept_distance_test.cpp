#include "reference/swept_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"

namespace riffler::reference::swept_distance_test {
namespace {

using Random = std::mt19937_64;

Vec3 point(Random& random, double size) {
  std::uniform_real_distribution<double> d(-size, size);
  const double x = d(random), y = d(random), z = d(random);
  return {x, y, z};
}

Vec3 unit(double x, double y, double z) {
  return glm::normalize(Vec3(x, y, z));
}

/// A whole ball of radius 3 whose centre is 3 above the tip.
tool::Profile ball() {
  return tool::Profile({{{3, 3}, Vec2(0, 3)}, {{0, 6}, Vec2(0, 3)}});
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
  return glm::length(p - a - t * (b - a));
}

/// Signed distance from the box |x| ≤ half.
double distance_to_box(const Vec3& p, const Vec3& half) {
  const Vec3 out = glm::abs(p) - half;
  return glm::length(glm::max(out, Vec3(0))) + std::min(0.0, std::max({out.x, out.y, out.z}));
}

TEST(SweptDistance, OfATravellingBallIsThatOfACapsule) {
  Random random(1);
  for (const double offset : {0.0, 1e5}) {
    const Vec3 a{offset + 1, 2 - offset, 3}, b = a + Vec3(11, -4, 2);
    const Vec3 axis = unit(0.3, 0.2, 1);
    const SweptDistance swept(ball(), Motion({a - 3.0 * axis, axis}, {b - 3.0 * axis, axis}));
    for (int k = 0; k < 500; ++k) {
      const Vec3 p = (a + b) / 2.0 + point(random, 12);
      EXPECT_NEAR(swept(p), distance_to_segment(p, a, b) - 3, 1e-9 + 1e-15 * offset * 8) << offset;
    }
  }
}

TEST(SweptDistance, OfABallTurningAboutItsTipIsThatOfAnArc) {
  Random random(2);
  const Vec3 tip{1, 2, 3};
  for (const double angle : {1e-6, 0.3, 2.0, 3.1}) {
    // The centre runs round the tip in the plane y = 2, from angle −¼ on.
    const auto axis = [](double a) { return Vec3(std::sin(a), 0, std::cos(a)); };
    const SweptDistance swept(ball(), Motion({tip, axis(-0.25)}, {tip, axis(angle - 0.25)}));
    for (int k = 0; k < 500; ++k) {
      const Vec3 p = tip + point(random, 7), w = p - tip;
      double at = std::atan2(w.x, w.z);
      if (at < -0.25 && at + 2 * std::acos(-1.0) < angle - 0.25) at += 2 * std::acos(-1.0);
      double expected = std::min(glm::length(w - 3.0 * axis(-0.25)), glm::length(w - 3.0 * axis(angle - 0.25)));
      if (at >= -0.25 && at <= angle - 0.25) expected = std::min(expected, glm::length(w - 3.0 * axis(at)));
      EXPECT_NEAR(swept(p), expected - 3, 1e-9) << angle;
    }
  }
}

TEST(SweptDistance, OfABallTurningAboutItsCentreIsThatOfTheBall) {
  Random random(3);
  const Vec3 from = unit(0.1, 0.2, 1), to = unit(1, -0.5, 0.2);
  const SweptDistance swept(ball(), Motion({-3.0 * from, from}, {-3.0 * to, to}));
  for (int k = 0; k < 30; ++k) {
    const Vec3 p = point(random, 6);
    // The tip moves on its chord, not round the centre: the ball's centre leaves the origin by the arc's rise.
    const double rise = 3 * (1 - std::cos(Motion({{}, from}, {{}, to}).angle() / 2));
    EXPECT_LE(swept(p), glm::length(p) - 3 + 1e-9);
    EXPECT_GE(swept(p), glm::length(p) - 3 - rise - 1e-9);
  }
}

TEST(SweptDistance, OfACylinderPlungingIsThatOfALongerCylinder) {
  Random random(4);
  const Tool tool = cutters::flat(6, 10);
  const SweptDistance swept(tool.profile(), Motion({{0, 0, 8}, {0, 0, 1}}, {{0, 0, -2}, {0, 0, 1}}));
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = point(random, 14) + Vec3(0, 0, 8);
    const double radial = glm::length(Vec2(p.x, p.y)) - 3, along = std::abs(p.z - 8) - 10;
    const double outside = glm::length(Vec2(std::max(radial, 0.0), std::max(along, 0.0)));
    const double whole = outside + std::min(0.0, std::max(radial, along));
    // Inside, the depth in the swept body is more than the depth in the tool ever was.
    if (whole > 0)
      EXPECT_NEAR(swept(p), whole, 1e-9);
    else
      EXPECT_LE(std::max(radial, -5.0), swept(p) + 1e-9);
    if (std::abs(whole) > 1e-9) {
      EXPECT_EQ(swept(p) > 0, whole > 0);
    }
  }
}

TEST(SweptDistance, OfACylinderTravellingAcrossItsAxisIsThatOfASlot) {
  Random random(5);
  const Tool tool = cutters::flat(6, 40);
  const SweptDistance swept(tool.profile(), Motion({{-10, 0, 0}, {0, 0, 1}}, {{10, 0, 0}, {0, 0, 1}}));
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = point(random, 17) + Vec3(0, 0, 20);
    const double radial = distance_to_segment({p.x, p.y, 0}, {-10, 0, 0}, {10, 0, 0}) - 3,
                 along = std::abs(p.z - 20) - 20;
    const double outside = glm::length(Vec2(std::max(radial, 0.0), std::max(along, 0.0)));
    EXPECT_NEAR(swept(p), outside + std::min(0.0, std::max(radial, along)), 1e-9);
  }
}

/// Where samples in time would find nothing.
TEST(SweptDistance, FindsABriefApproach) {
  // A disc of 0.02 mm flies 4 m: it is at each point for five millionths of the time.
  const Tool tool = cutters::flat(6, 0.02);
  const SweptDistance swept(tool.profile(), Motion({{0, 0, -2000}, {0, 0, 1}}, {{0, 0, 2000}, {0, 0, 1}}));
  Random random(6);
  for (int k = 0; k < 50; ++k) {
    const Vec3 p = point(random, 2);
    EXPECT_NEAR(swept(p), -0.01, 1e-9);
  }
  // The same while turning, with its edge in the path.
  const SweptDistance turning(tool.profile(), Motion({{0, 0, -2000}, {0, 0, 1}}, {{0, 0, 2000}, unit(1, 0, 0.3)}));
  for (int k = 0; k < 50; ++k) EXPECT_LT(turning(point(random, 1)), -0.0099);
}

std::vector<Tool> tools() {
  return {cutters::ball(6, 20),
          cutters::flat(6, 0.3),
          cutters::fillet(8, 1, 20),
          cutters::taper(0.5, 0.2, 8, 30),
          cutters::cone_end(1.0, 1, 0.4, 8, 30),
          cutters::profile({{{1.5, 0}, {}}, {{3, 1.5}, Vec2(1.5, 1.5)}, {{2, 6}, {}}, {{4, 8}, {}}}, 20),
          cutters::profile({{{1, 0}, {}}, {{1, 1}, {}}, {{4, 4}, Vec2(4, 1)}}, 12)};
}

/// No sample is below the lower bound, and some samples come near the upper one, which is a distance that was met.
TEST(SweptDistance, BracketsTheDistanceOfSamples) {
  Random random(7);
  for (const Tool& tool : tools()) {
    const CutterDistance cutter(tool.profile());
    for (int k = 0; k < 120; k += test::kSanitized ? 5 : 1) {
      const Vec3 a = glm::normalize(point(random, 1)), b = k < 60 ? glm::normalize(point(random, 1)) : a;
      const Vec3 start = point(random, 4), end = start + (k % 3 ? point(random, 4) : Vec3(0));
      const Motion motion({start, a}, {end, b});
      const Vec3 p = start + point(random, 8);
      const double gap = k % 2 ? 1e-9 : 1e-3;
      const Bracket found = SweptDistance(tool.profile(), motion).bracket(p, gap);
      EXPECT_LE(found.upper - found.lower, gap);
      double sampled = std::numeric_limits<double>::infinity();
      constexpr int kSamples = 20000;
      for (int i = 0; i <= kSamples; ++i) {
        const double t = static_cast<double>(i) / kSamples;
        const Vec3 w = p - motion.tip(t), o = motion.axis(t);
        const double z = glm::dot(w, o);
        sampled = std::min(sampled, cutter.distance(glm::length(w - z * o), z));
      }
      EXPECT_GE(sampled, found.lower - 1e-12);
      EXPECT_LE(sampled, found.upper + 60.0 / kSamples + gap);
    }
  }
}

TEST(SweptDistance, StopsOnceTheBracketSuffices) {
  const Tool tool = cutters::fillet(8, 1, 20);
  const SweptDistance swept(tool.profile(), Motion({{0, 0, 0}, {0, 0, 1}}, {{9, 2, 1}, unit(1, 0.2, 0.3)}));
  Random random(8);
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = point(random, 20);
    const Bracket whole = swept.bracket(p, 1e-9), quick = swept.bracket(p, 1e-9, 0.01);
    EXPECT_LE(quick.lower, whole.upper + 1e-12);
    EXPECT_GE(quick.upper, whole.lower - 1e-12);
    EXPECT_LE(quick.poses, whole.poses);
    EXPECT_TRUE(quick.upper - quick.lower <= 1e-9 || quick.lower > 0.01 || quick.upper < -0.01);
  }
}

TEST(SweptDistance, NeedsFewPoses) {
  // Counted, so that a bound that became loose is seen: dense sampling would take some hundred and prove nothing.
  Random random(9);
  long poses = 0, queries = 0;
  for (const Tool& tool : tools())
    for (int k = 0; k < 200; ++k) {
      const Vec3 start = point(random, 4), a = glm::normalize(point(random, 1));
      const Motion motion({start, a}, {start + point(random, 3), glm::normalize(a + point(random, 0.5))});
      poses += SweptDistance(tool.profile(), motion).bracket(start + point(random, 8), 1e-9).poses, ++queries;
    }
  EXPECT_LT(poses, 120 * queries);
}

TEST(SweptDistance, NeedsVeryFewPosesOnStraightMoves) {
  Random random(13);
  for (const Tool& tool : tools()) {
    const CutterDistance cutter(tool.profile());
    if (!cutter.convex() && !cutter.slices_convex()) continue;
    long poses = 0;
    constexpr int kQueries = 400;
    for (int k = 0; k < kQueries; ++k) {
      const Vec3 start = point(random, 4), axis = glm::normalize(point(random, 1));
      const SweptDistance swept(tool.profile(), Motion({start, axis}, {start + point(random, 30), axis}));
      const Bracket found = swept.bracket(start + point(random, 30), 1e-9, -1e-9, 1e9);
      if (found.upper < 0) continue;  // inside a cutter that is not convex, the search is another one
      EXPECT_LT(found.poses, 60);
      poses += found.poses;
    }
    EXPECT_LT(poses, 10L * static_cast<long>(1 + cutter.slices()) * kQueries) << tool.kind();
  }
}

/// A point that an edge passes within rounding has no gradient there, and neither have the poses before and after.
TEST(SweptDistance, NeedsFewPosesWhereAnEdgeTouchesThePoint) {
  const Vec3 level{0, 1, 0}, steep{0, 0.6, 0.8};
  for (const Vec3& way : {level, steep}) {
    const SweptDistance swept(cutters::flat(6, 0.3).profile(), Motion({-3.0 * way, {0, 0, 1}}, {3.0 * way, {0, 0, 1}}));
    for (const double off : {0.0, 1e-16, -1e-16, 1e-12, 1e-9, 4e-8}) {
      const Bracket found = swept.bracket({3 + off, 0, 0}, 1e-13);
      EXPECT_LE(found.poses, 60) << off;
      EXPECT_NEAR(found.upper, std::max(off, 0.0), 1e-13 - std::min(off, 0.0));
    }
  }
}

TEST(CutterDistance, OfAFlatCutterIsThatOfACylinder) {
  const CutterDistance cutter(cutters::flat(6, 10).profile());
  Random random(10);
  for (int k = 0; k < 500; ++k) {
    const Vec3 p = point(random, 8);
    const double rho = std::abs(p.x), z = p.z + 5;
    // A cylinder's half-section is that of a box whose third side has no end.
    EXPECT_NEAR(cutter.distance(rho, z), distance_to_box({rho, 0, z - 5}, {3, 100, 5}), 1e-14);
  }
}

/// The outline as a polygon of many corners.
std::vector<Vec2> outline(const tool::Profile& profile, int parts) {
  std::vector<Vec2> corners{{0, 0}};
  for (const tool::ProfileSegment& s : profile.segments()) {
    const Vec2 from = corners.back();
    for (int k = 1; k <= parts; ++k) {
      const double t = static_cast<double>(k) / parts;
      Vec2 corner = glm::mix(from, s.to, t);
      if (s.centre) {
        const Vec2 a = from - *s.centre, b = s.to - *s.centre;
        const double turn = std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b)), c = std::cos(turn * t),
                     d = std::sin(turn * t);
        corner = *s.centre + Vec2(c * a.x - d * a.y, d * a.x + c * a.y);
      }
      corners.push_back(corner);
    }
  }
  const Vec2 top = corners.back();
  for (int k = 1; k <= parts; ++k) corners.push_back({top.x * (parts - k) / parts, top.y});
  return corners;
}

TEST(CutterDistance, OfEveryCutterIsThatOfItsOutline) {
  Random random(12);
  for (const Tool& tool : tools()) {
    const CutterDistance cutter(tool.profile());
    const std::vector<Vec2> corners = outline(tool.profile(), 4000);
    const double step = tool.profile().length() / 4000;  // the longest segment's, about
    for (int k = 0; k < 60; ++k) {
      const Vec3 p = point(random, 10);
      const Vec2 q{std::abs(p.x), p.z + 6};
      double nearest = glm::length(q);
      bool inside = false;
      for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vec2 &a = corners[i], &b = corners[i + 1];
        nearest = std::min(nearest, glm::length(q - b));
        if ((a.y > q.y) != (b.y > q.y) && q.x < a.x + (b.x - a.x) * (q.y - a.y) / (b.y - a.y)) inside = !inside;
      }
      EXPECT_NEAR(cutter.distance(q.x, q.y), inside ? -nearest : nearest, step);
    }
  }
}

TEST(CutterDistance, SupportsHaveTheWholeConvexCutterBehindThem) {
  Random random(14);
  for (const Tool& tool : tools()) {
    const CutterDistance cutter(tool.profile());
    if (!cutter.convex()) continue;
    const std::vector<Vec2> corners = outline(tool.profile(), 50);
    for (int k = 0; k < 1000; ++k) {
      Vec3 p = point(random, 10);
      if (k % 2) {  // at a corner, or next to it
        const Vec2& corner = corners[random() % corners.size()];
        p = Vec3(corner.x, 0, corner.y - 6) + (k % 4 == 1 ? 0 : 1e-12) * p;
      }
      const double rho = std::abs(p.x), z = p.z + 6;
      const Nearest at = cutter.nearest(rho, z);
      EXPECT_NEAR(glm::length(at.support), 1, 1e-12);
      const Vec2 foot = Vec2(rho, z) - at.distance * at.support;
      for (const Vec2& q : corners)
        for (const double side : {1.0, -1.0}) ASSERT_LT(glm::dot(Vec2(side * q.x, q.y) - foot, at.support), 1e-11);
      if (at.normal) {
        EXPECT_LT(glm::length(*at.normal - at.support), 1e-7);
      }
    }
  }
}

TEST(CutterDistance, FreeBallsStayOutOfTheCutter) {
  Random random(11);
  for (const Tool& tool : tools()) {
    const CutterDistance cutter(tool.profile());
    int found = 0;
    for (int k = 0; k < 300; ++k) {
      const Vec3 p = point(random, 10);
      const double rho = std::abs(p.x), z = p.z + 6;
      const Nearest at = cutter.with_free_radius(rho, z, cutter.nearest(rho, z));
      const double radius = std::min(at.free_radius, 1e3);
      if (!(radius > 0)) continue;
      ++found;
      const Vec2 foot = Vec2(rho, z) - at.distance * *at.normal;
      EXPECT_NEAR(cutter.distance(foot.x, foot.y), 0, 1e-12);
      const Vec2 centre = foot + radius * *at.normal;
      EXPECT_GE(cutter.distance(std::abs(centre.x), centre.y), radius - 1e-10);
    }
    EXPECT_GT(found, 200);
  }
}

}  // namespace
}  // namespace riffler::reference::swept_distance_test
