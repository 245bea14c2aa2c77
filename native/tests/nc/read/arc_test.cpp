#include "nc/read/arc.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace riffler::nc::arc_test {
namespace {

Vec2 on(double r, double angle) {
  return {r * std::cos(angle), r * std::sin(angle)};
}

TEST(Arc, TurnsInTheGivenDirectionThroughAnyAngle) {
  const Vec2 centre(3, -4);
  for (const double start : {-3.0, 0.0, 0.7, kPi})
    for (const double sweep : {1e-3, 0.5, kPi / 2, kPi - 1e-6, kPi + 1e-6, 5.0, 2 * kPi - 1e-3})
      for (const bool clockwise : {false, true}) {
        const double signed_sweep = clockwise ? -sweep : sweep;
        const Vec2 from = centre + on(10, start), to = centre + on(10, start + signed_sweep);
        const Arc about = arc_about(from, to, centre, clockwise);
        const Arc by_radius = arc_of_radius(from, to, sweep < kPi ? 10 : -10, clockwise);
        for (const Arc& arc : {about, by_radius}) {
          EXPECT_NEAR(arc.sweep, signed_sweep, 1e-8);
          EXPECT_LT(glm::length(arc.centre - centre), 1e-5);
          EXPECT_LT(glm::length(arc.at(0) - from), 1e-9);
          EXPECT_LT(glm::length(arc.at(1) - to), 1e-9);
          EXPECT_LT(glm::length(arc.at(0.5) - (centre + on(10, start + signed_sweep / 2))), 1e-5);
        }
      }
}

TEST(Arc, ThatEndsWhereItBeginsIsAFullCircle) {
  const Arc arc = arc_about({10, 0}, {10, 0}, {0, 0}, true);
  EXPECT_EQ(arc.sweep, -2 * kPi);
  EXPECT_NEAR(arc.length(), 20 * kPi, 1e-12);
  EXPECT_THROW(arc_of_radius({10, 0}, {10, 0}, 5, true), std::invalid_argument);
}

TEST(Arc, HalfCircleByRadiusSurvivesRounding) {
  for (const double radius : {5.0, 5 - 1e-9, -5.0, 4.999, -4.999}) {
    const Arc arc = arc_of_radius({0, 0}, {10, 0}, radius, true);
    EXPECT_NEAR(arc.sweep, -kPi, 1e-4);
    EXPECT_NEAR(arc.at(0.5).y, 5, 1e-3);
  }
}

TEST(Arc, WhoseEndMissesItsCircleIsRefused) {
  EXPECT_NO_THROW(arc_about({10, 0}, {0, 10.0049}, {0, 0}, false));
  EXPECT_THROW(arc_about({10, 0}, {0, 10.0051}, {0, 0}, false), std::invalid_argument);
  EXPECT_THROW(arc_about({10, 0}, {0, 9.9949}, {0, 0}, false), std::invalid_argument);
  EXPECT_NO_THROW(arc_of_radius({0, 0}, {10, 0}, 4.99874, false));
  EXPECT_THROW(arc_of_radius({0, 0}, {10, 0}, 4.99872, false), std::invalid_argument);
  EXPECT_NO_THROW(arc_about({0.00128, 0}, {0, 0.00128}, {0, 0}, false));
  EXPECT_THROW(arc_about({0.00126, 0}, {0, 0.00126}, {0, 0}, false), std::invalid_argument);
  EXPECT_NO_THROW(arc_of_radius({0, 0}, {1e-5, 0}, 1e-5, false));
  EXPECT_THROW(arc_about({10, 0}, {10, 0}, {10, 0}, false), std::invalid_argument);
  EXPECT_THROW(arc_of_radius({0, 0}, {0.001, 0}, 0, false), std::invalid_argument);
}

TEST(Arc, ChordsKeepToTheToleranceAndAreNotManyMore) {
  for (const double r : {0.002, 0.5, 10.0, 1e4})
    for (const double tolerance : {0.1, 0.002, 1e-5}) {
      const Arc arc = arc_about({r, 0}, {r, 0}, {0, 0}, false);
      const int n = arc.chords(tolerance);
      const double sagitta = r - glm::length(arc.at(0) + arc.at(1.0 / n)) / 2;
      EXPECT_LE(sagitta, tolerance * (1 + 1e-9) + 1e-12);
      EXPECT_TRUE(n <= 8 || r * (1 - std::cos(kPi / (n - 1))) >= tolerance) << "one chord less would not do";
    }
}

}  // namespace
}  // namespace riffler::nc::arc_test
