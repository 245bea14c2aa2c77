#include "riffler/plan/engrave.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "riffler/tool/cutters.hpp"

namespace riffler::plan::engrave_test {
namespace {

Mesh box(double half) {
  Mesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back({k & 1 ? half : -half, k & 2 ? half : -half, k & 4 ? half : -half});
  for (const auto& t : {Vec3i(0, 2, 1),
                        {1, 2, 3},
                        {4, 5, 6},
                        {5, 7, 6},
                        {0, 1, 4},
                        {1, 5, 4},
                        {2, 6, 3},
                        {3, 6, 7},
                        {0, 4, 2},
                        {2, 4, 6},
                        {1, 3, 5},
                        {3, 7, 5}})
    mesh.triangles.push_back(t);
  return mesh;
}

Mesh sphere(double radius, int n) {
  Mesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const double a = kPi * i / n, b = kPi * j / n;
      mesh.vertices.push_back(radius * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const int a = i * 2 * n + j, b = i * 2 * n + (j + 1) % (2 * n);
      mesh.triangles.push_back({a, a + 2 * n, b + 2 * n}), mesh.triangles.push_back({a, b + 2 * n, b});
    }
  return mesh;
}

TEST(Engrave, OnAPlaneTheTipGoesAtItsDepthAndNothingIsDivided) {
  const Tool tool = cutters::cone_end(0.5, 2, 0.5, 6, 20);
  const auto found = engrave(box(50), {{{-20, -20, 51}, {20, -20, 50}, {20, 20, 49}}}, tool, {.depth = 0.3});
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].poses.size(), 3u);
  EXPECT_NEAR(found[0].poses[1].tip.z, 49.7, 1e-12);
  for (const Pose& pose : found[0].poses) EXPECT_LT(glm::length(pose.axis - Vec3(0, 0, 1)), 1e-12);
}

TEST(Engrave, OnASphereChordsKeepTheToleranceAndTheAxisFollows) {
  const int n = 90;
  const double radius = 40, facet = radius * (1 - std::cos(kPi / n));
  for (const double tolerance : {0.1, 0.01}) {
    const EngraveOptions options{.depth = 0.5, .tolerance = tolerance, .turn = 0.05, .reach = 25};
    const auto found = engrave(sphere(radius, n), {{{-25, 5, 30}, {25, 5, 30}}}, cutters::ball(2, 20), options);
    const Engraved& cut = found[0];
    ASSERT_GT(cut.poses.size(), 20u);
    for (std::size_t k = 0; k < cut.poses.size(); ++k) {
      const Vec3 out = glm::normalize(cut.contacts[k]);
      EXPECT_LT(glm::length(cut.poses[k].axis - out), 0.02);  // between facets of 2°
      // The ball's lowest point at its depth.
      EXPECT_NEAR(glm::length(cut.poses[k].tip + cut.poses[k].axis) - 1, radius - 0.5, facet + 1e-3);
      if (k == 0) continue;
      EXPECT_LT(glm::length(cut.poses[k].axis - cut.poses[k - 1].axis), 0.0501);
      const double middle = glm::length(0.5 * (cut.contacts[k] + cut.contacts[k - 1]));
      EXPECT_GT(middle, radius - facet - tolerance);
    }
  }
}

TEST(Engrave, TheAxisLeansByTheGivenAngles) {
  const EngraveOptions options{.depth = 0.2, .inclination = 0.3, .tilt = -0.2};
  const auto found = engrave(box(50), {{{-20, 0, 50}, {20, 0, 50}}}, cutters::ball(6, 20), options);
  for (const Pose& pose : found[0].poses) {
    const Vec3 expected{std::cos(0.2) * std::sin(0.3), -std::sin(0.2), std::cos(0.2) * std::cos(0.3)};
    EXPECT_LT(glm::length(pose.axis - expected), 1e-12);
    EXPECT_NEAR((pose.tip + 3.0 * pose.axis).z, 50 - 0.2 + 3, 1e-12);
  }
}

TEST(Engrave, OverASharpEdgeTheAxisTurnsAtOnceAndTheCurveContinues) {
  const auto found = engrave(box(50), {{{20, 0, 50}, {49, 0, 50}, {50, 0, 49}, {50, 0, 20}}}, cutters::ball(2, 20));
  const Engraved& cut = found[0];
  ASSERT_LT(cut.poses.size(), 100u);
  EXPECT_LT(glm::length(cut.poses.front().axis - Vec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::length(cut.poses.back().axis - Vec3(1, 0, 0)), 1e-12);
  for (std::size_t k = 1; k < cut.contacts.size(); ++k) {
    const Vec3 middle = 0.5 * (cut.contacts[k] + cut.contacts[k - 1]);
    EXPECT_GT(std::max(middle.x, middle.z), 50 - 0.0101);
  }
}

TEST(Engrave, BadInputNamesTheCurveAndItsPoint) {
  const Mesh part = box(50);
  const Tool tool = cutters::ball(2, 20);
  const auto message = [&](const std::vector<Vec3>& curve, const EngraveOptions& options) -> std::string {
    try {
      engrave(part, {{{0, 0, 50}, {1, 0, 50}}, curve}, tool, options);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message({{0, 0, 50}}, {}), "curve 1 has fewer than two points");
  EXPECT_EQ(message({{0, 0, 50}, {0, nan, 50}}, {}), "curve 1, point 1 is not finite");
  EXPECT_EQ(message({{0, 0, 50}, {0, 0, 50}}, {}), "curve 1 has all its points at one place");
  EXPECT_NE(message({{0, 0, 50}, {0, 0, 80}}, {}).find("curve 1, point 1 is 30"), std::string::npos);
  EXPECT_EQ(message({{0, 0, 50}, {1, 0, 50}}, {.tolerance = 0}),
            "tolerance must be a positive length in mm, from 1e-08 to 1e+30, not 0");
  EXPECT_THROW(engrave(Mesh{}, {}, tool), std::invalid_argument);
  EXPECT_TRUE(engrave(part, {}, tool).empty());
}

}  // namespace
}  // namespace riffler::plan::engrave_test
