// Ridges between two places of a cutter, compared with closed forms.
#include "plan/finish/cusp.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "riffler/tool/cutters.hpp"

namespace riffler::plan::cusp_test {
namespace {

TEST(CutterProfile, RidgesOfABallDependOnTheDistanceOfItsCentresAlone) {
  const CutterProfile ball(cutters::ball(6, 30));
  for (const double length : {1e-4, 0.01, 0.2, 1.0, 2.0})
    for (const double slope : {0.0, 0.3, 0.8, 1.2, 1.4}) {
      const double across = length * std::cos(slope), up = length * std::sin(slope);
      // Above that slope the crossing lies beyond the rim of the lower ball, where its shank takes over.
      const double beyond = std::asin(1.0) - std::asin(std::min(1.0, length / 6));
      if (slope > beyond) continue;
      const double height = 3 - std::sqrt(9 - length * length / 4);
      // Tangents touch the profile at 257 points: the bow between two of them is 1.4e-5 mm.
      EXPECT_NEAR(ball.ridge(across, up), height, 1.5e-5 + 2e-3 * height) << length << ' ' << slope;
      EXPECT_EQ(ball.ridge(-across, -up), ball.ridge(across, up));
    }
}

TEST(CutterProfile, RidgesOfAFlatAreTheStepsOfItsCorner) {
  const CutterProfile flat(cutters::flat(6, 30));
  for (const double across : {0.01, 0.5, 3.0})
    for (const double up : {0.0, 0.02, 1.0, 5.0})
      EXPECT_NEAR(flat.ridge(across, up), up * across / std::max(1e-300, std::hypot(up, across)), 1e-9);
  EXPECT_EQ(flat.ridge(0, 3), 0);
}

TEST(CutterProfile, SpacingLeavesTheGivenCusp) {
  for (const double cusp : {0.001, 0.01, 0.1}) {
    const CutterProfile ball(cutters::ball(6, 30));
    EXPECT_NEAR(ball.spacing(cusp), 2 * std::sqrt(9 - (3 - cusp) * (3 - cusp)), 1e-3 * ball.spacing(cusp));
  }
}

TEST(CutterProfile, HasTheRadiusOfAHeight) {
  const CutterProfile ball(cutters::ball(6, 30)), flat(cutters::flat(6, 30));
  for (const double height : {0.0, 0.5, 2.0}) {
    EXPECT_NEAR(ball.radius_at(height), std::sqrt(9 - (3 - height) * (3 - height)), 1e-6);
    EXPECT_EQ(flat.radius_at(height), 3);
  }
  EXPECT_EQ(ball.radius_at(5), 3);
}

}  // namespace
}  // namespace riffler::plan::cusp_test
