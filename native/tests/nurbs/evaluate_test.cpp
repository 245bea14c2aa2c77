#include <gtest/gtest.h>

#include "nurbs/quadrics.hpp"
#include "riffler/nurbs/surface.hpp"
#include "support/error_of.hpp"

namespace riffler::nurbs::evaluate_test {
namespace {

using test::error_of;

TEST(SurfaceEvaluate, FollowsTheDefinitionForAnyDegreeKnotsAndWeights) {
  std::mt19937 random(1);
  for (const double weights : {1.0, 3.0, 1e3})
    for (int p = 1; p <= 5; ++p)
      for (int q = 1; q <= 4; ++q) {
        const Patch patch = shapes::random_patch(random, p, q, weights);
        const std::vector<Vec2> uv = shapes::grid(patch, 12);
        const std::vector<SurfacePoint> found = Surface({patch}).evaluate(uv);
        for (std::size_t i = 0; i < uv.size(); ++i) {
          EXPECT_LT(glm::length(found[i].point - shapes::by_definition(patch, uv[i])), 1e-11);
          EXPECT_NEAR(glm::length(found[i].normal), 1, 1e-12);
        }
      }
}

TEST(SurfaceEvaluate, NormalsAreTheDirectionOfDifferencesOfPoints) {
  std::mt19937 random(2);
  for (int k = 0; k < 20; ++k) {
    const Patch patch = shapes::random_patch(random, 1 + k % 4, 1 + k / 5, 10);
    const Surface surface({patch});
    std::uniform_real_distribution<double> share(0.01, 0.99);
    for (int i = 0; i < 20; ++i) {
      const double h = 1e-6;
      const Vec2 at = glm::mix(patch.lower(), patch.upper(), Vec2(share(random), share(random)));
      const auto point = [&](double du, double dv) { return shapes::by_definition(patch, at + Vec2(du, dv)); };
      const Vec3 n = glm::cross(point(h, 0) - point(-h, 0), point(0, h) - point(0, -h));
      if (glm::length(n) < 1e-13) continue;  // h across a knot, or nearly singular
      const SurfacePoint found = surface.evaluate(std::vector{at})[0];
      EXPECT_GT(glm::dot(found.normal, glm::normalize(n)), 1 - 1e-3);
    }
  }
}

TEST(SurfaceEvaluate, PolesHaveTheLimitOfTheNormals) {
  for (const Vec3& offset : {Vec3(0), Vec3(1e5, -1e5, 1e5)}) {
    const Patch patch = shapes::ball(7, 4, offset);
    const std::vector<Vec2> uv = shapes::grid(patch, 33);
    const std::vector<SurfacePoint> found = Surface({patch}).evaluate(uv);
    for (std::size_t i = 0; i < uv.size(); ++i)
      EXPECT_LT(glm::length(found[i].normal - (found[i].point - offset) / 7.0), 1e-9) << uv[i].x << " " << uv[i].y;
  }
  // A cone's apex has the normal of the line that leads to it.
  const Patch cone = shapes::turned(shapes::line({4, 0}, {0, 3}));
  for (int k = 0; k <= 16; ++k) {
    const double u = k / 4.0;
    const auto found = Surface({cone}).evaluate(std::vector{Vec2(u, 1), Vec2(u, 0.5)});
    EXPECT_EQ(found[0].point, Vec3(0, 0, 3));
    EXPECT_LT(glm::length(found[0].normal - found[1].normal), 1e-12);
  }
}

TEST(SurfaceEvaluate, APatchWithoutAreaHasNoNormal) {
  Patch flat = shapes::turned(shapes::line({4, 0}, {4, 0}));
  EXPECT_EQ(Surface({flat}).evaluate(std::vector{Vec2(1.3, 0.4)})[0].normal, Vec3(0));
  flat.points.assign(flat.points.size(), Vec3(1, 2, 3));
  const SurfacePoint point = Surface({flat}).evaluate(std::vector{Vec2(1.3, 0.4)})[0];
  EXPECT_EQ(point.point, Vec3(1, 2, 3));
  EXPECT_EQ(point.normal, Vec3(0));
}

TEST(SurfaceEvaluate, RefusesParametersOutsideTheDomainAndPatchesThatDoNotExist) {
  const Surface surface({shapes::ball(1)});
  const double nan = std::nan("");
  for (const Vec2& bad : {Vec2(-0.1, 0), Vec2(4.1, 1), Vec2(1, 2.5), Vec2(nan, 0), Vec2(0, nan)})
    EXPECT_NE(error_of([&] { surface.evaluate(std::vector{Vec2(0), bad}); }).find("uv, row 1: "), std::string::npos);
  EXPECT_NE(error_of([&] { surface.evaluate(std::vector{Vec2(0)}, 1); }).find("patch 1 does not exist"),
            std::string::npos);
}

}  // namespace
}  // namespace riffler::nurbs::evaluate_test
