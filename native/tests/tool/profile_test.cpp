#include "riffler/tool/profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "riffler/dexel/volume.hpp"
#include "riffler/sweep/carve.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/error_of.hpp"

namespace riffler::tool::profile_test {
namespace {

/// mm³ that a cutter takes out of a block that it is sunk into, tip at 2 mm below the top.
double sunk(const std::vector<ProfileSegment>& segments) {
  Volume volume = Volume::block({{{-4, -4, -6}, {4, 4, 0}}, 0.05, "z"});
  const sweep::Cut cut = sweep::carve(volume, cutters::profile(segments, 20),
                                      std::vector<Pose>{{{0, 0, 5}, {0, 0, 1}}, {{0, 0, -2}, {0, 0, 1}}});
  return cut.removed[0];
}

/// From (1, 0) to (2, 3), about a centre so far away that the arc is `sag` off its chord in the middle.
ProfileSegment flat_arc(double radius, bool convex) {
  const Vec2 a(1, 0), b(2, 3), half = 0.5 * (b - a), out = glm::normalize(Vec2(half.y, -half.x));
  const double depth = std::sqrt(radius * radius - glm::dot(half, half));
  return {b, a + half + (convex ? -depth : depth) * out};
}

TEST(Profile, ArcsThatAreNearlyStraightCutAsALineDoes) {
  const double line = sunk({{{1, 0}, {}}, {{2, 3}, {}}});
  // A cone of radius 1 to 5/3 over 2 mm.
  EXPECT_NEAR(line, std::acos(-1.0) * 2 / 3 * (1 + 5.0 / 3 + 25.0 / 9), 0.1);
  for (const double radius : {1e3, 1e4, 1e5, 9e5})
    for (const bool convex : {false, true})
      EXPECT_NEAR(sunk({{{1, 0}, {}}, flat_arc(radius, convex)}), line, 2 * 10 * (10 / (8 * radius)) + 1e-3) << radius;
}

TEST(Profile, CentresTooFarToDistinguishArcsFromLinesAreRefused) {
  for (const double radius : {1e9, 1e12, 1e100, 1e155})
    EXPECT_NE(test::error_of([&] { cutters::profile({{{1, 0}, {}}, flat_arc(radius, false)}, 20); }).find("centre"),
              std::string::npos)
        << radius;
  for (const double x : {1e9, -1e9, 1e155})
    EXPECT_NE(test::error_of([&] { cutters::profile({{{1, 0}, {}}, {{2, 3}, Vec2(x, 1)}}, 20); }), "") << x;
}

TEST(Profile, HowFarAnEndMayBeOffItsArcDoesNotGrowWithTheRadius) {
  ProfileSegment arc = flat_arc(1e5, true);
  arc.to.x += 0.01;  // a ten-millionth of the radius
  EXPECT_NE(test::error_of([&] { cutters::profile({{{1, 0}, {}}, arc}, 20); }).find("equally far"), std::string::npos);
}

}  // namespace
}  // namespace riffler::tool::profile_test
