#include "riffler/geom/pose.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace riffler::geom::pose_test {
namespace {

TEST(Motion, KeepsTheAxisUnitAndEndsExactlyAtItsEnds) {
  const Pose a{{0, 0, 0}, {0, 0, 1}}, b{{1, 2, 3}, glm::normalize(Vec3(1, -2, 0.5))};
  const Motion m(a, b);
  EXPECT_EQ(m.axis(0), a.axis);
  EXPECT_EQ(m.axis(1), b.axis);
  for (int i = 0; i <= 10; ++i) EXPECT_NEAR(glm::length(m.axis(i / 10.0)), 1, 1e-15);
}

TEST(Motion, TurnsAtConstantRate) {
  const Motion m({{0, 0, 0}, {0, 0, 1}}, {{0, 0, 0}, {1, 0, 0}});
  for (int i = 0; i <= 8; ++i) {
    const Vec3 axis = m.axis(i / 8.0);
    EXPECT_NEAR(std::atan2(axis.x, axis.z), i / 8.0 * std::acos(-1.0) / 2, 1e-15);
  }
}

TEST(Motion, SurvivesTinyAndZeroAngles) {
  const Pose a{{0, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(Motion(a, a).angle(), 0);
  EXPECT_EQ(Motion(a, a).axis(0.5), a.axis);
  const Motion tiny(a, {{0, 0, 0}, glm::normalize(Vec3(1e-12, 0, 1))});
  EXPECT_NEAR(tiny.angle(), 1e-12, 1e-24);
  EXPECT_NEAR(tiny.axis(0.5).x, 5e-13, 1e-24);
}

TEST(Motion, VelocityIsTheDerivativeOfMaterialPoints) {
  const Motion m({{1, 2, 3}, glm::normalize(Vec3(0.2, 0.1, 1))}, {{2, 1, 5}, glm::normalize(Vec3(-0.3, 0.4, 1))});
  // A point on the axis at height 20 is a material point whose path is known: tip(t) + 20 axis(t).
  const double t = 0.37, d = 1e-6;
  const Vec3 difference = (m.tip(t + d) + 20.0 * m.axis(t + d) - m.tip(t - d) - 20.0 * m.axis(t - d)) / (2 * d);
  EXPECT_LT(glm::length(m.velocity(m.tip(t) + 20.0 * m.axis(t), t) - difference), 1e-7);
}

}  // namespace
}  // namespace riffler::geom::pose_test
