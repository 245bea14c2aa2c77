#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "nurbs/quadrics.hpp"
#include "riffler/nurbs/surface.hpp"
#include "support/error_of.hpp"

namespace riffler::nurbs::closest_test {
namespace {

using test::error_of;

std::vector<Vec3> random_points(std::mt19937& random, std::size_t n, double size) {
  std::uniform_real_distribution<double> share(-size, size);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < n; ++i) points.emplace_back(share(random), share(random), share(random));
  return points;
}

/// Distances to a surface about z, whose profile's distance is `truth`, for points at random and on the axis.
void expect_distances(const Surface& surface, const Vec3& offset, double tolerance,
                      const std::function<double(const Vec2&)>& truth) {
  std::mt19937 random(3);
  std::vector<Vec3> points = random_points(random, 150, 20);
  for (int k = -8; k <= 8; ++k) points.emplace_back(0, 0, 1.7 * k);  // on the axis, its centre among them
  for (int k = 0; k < 20; ++k) points.emplace_back(1e-9 * k, -1e-6 * k, 5 + 0.4 * k);
  points.emplace_back(1e4, 2e4, -3e4);
  for (Vec3& p : points) p += offset;
  const std::vector<Foot> feet = surface.closest(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i] - offset;
    const double expected = truth({std::hypot(p.x, p.y), p.z});
    EXPECT_NEAR(feet[i].distance, expected, tolerance * (1 + 1e-4 * expected)) << p.x << " " << p.y << " " << p.z;
    EXPECT_NEAR(glm::length(feet[i].point - points[i]), feet[i].distance, tolerance);
    EXPECT_LT(glm::length(feet[i].point - surface.evaluate(std::vector{feet[i].uv}, feet[i].patch)[0].point),
              10 * tolerance);
    if (feet[i].distance > 1e-3) continue;
    EXPECT_NEAR(glm::length(feet[i].normal), 1, 1e-12);
  }
}

TEST(SurfaceClosest, HasTheDistancesOfQuadricsAndTori) {
  const auto segment = [](const Vec2& a, const Vec2& b) {
    return [=](const Vec2& p) {
      const double t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      return glm::length(p - a - t * (b - a));
    };
  };
  for (const Vec3& offset : {Vec3(0), Vec3(1e5, -1e5, 7e4)}) {
    const double tolerance = offset.x > 0 ? 2e-8 : 1.1e-9;
    expect_distances(Surface({shapes::ball(7, 4, offset)}), offset, tolerance,
                     [](const Vec2& p) { return std::abs(glm::length(p) - 7); });
    expect_distances(Surface({shapes::torus(10, 3, offset)}), offset, tolerance,
                     [](const Vec2& p) { return std::abs(glm::length(p - Vec2(10, 0)) - 3); });
    expect_distances(Surface({shapes::turned(shapes::line({6, -5}, {6, 9}), 4, offset)}), offset, tolerance,
                     segment({6, -5}, {6, 9}));
    expect_distances(Surface({shapes::turned(shapes::line({6, -5}, {0, 9}), 4, offset)}), offset, tolerance,
                     segment({6, -5}, {0, 9}));
  }
}

TEST(SurfaceClosest, FindsTheNearestOfOctants) {
  // A quarter of a ball in two octants: distances where the nearest point is on a border, too.
  const Surface octants({shapes::ball(7, 1)});
  std::mt19937 random(4);
  for (const Vec3& p : random_points(random, 200, 15)) {
    const Foot foot = octants.closest(std::vector{p})[0];
    double expected = std::abs(glm::length(p) - 7);
    if (p.x < 0 || p.y < 0) {  // on one of the two meridians
      const auto meridian = [&](double along, double across) {
        return along > 0 ? std::hypot(std::hypot(along, p.z) - 7, across)
                         : std::hypot(along, std::hypot(across, std::abs(p.z) - 7));
      };
      expected = std::min(meridian(p.x, p.y), meridian(p.y, p.x));
    }
    EXPECT_NEAR(foot.distance, expected, 1.1e-9);
  }
}

/// The least distance of a dense grid of points by another evaluation: never less than the true one.
double sampled(const std::vector<Vec3>& samples, const Vec3& p) {
  double best = std::numeric_limits<double>::infinity();
  for (const Vec3& s : samples) best = std::min(best, glm::dot(s - p, s - p));
  return std::sqrt(best);
}

TEST(SurfaceClosest, IsNeverALocalMinimum) {
  std::mt19937 random(5);
  for (const double weights : {1.0, 10.0, 1e3})
    for (int k = 0; k < 6; ++k) {
      const Patch patch = shapes::random_patch(random, 1 + k % 4, 1 + k % 3, weights);
      const Surface surface({patch});
      std::vector<Vec3> samples;
      for (const Vec2& uv : shapes::grid(patch, 90)) samples.push_back(shapes::by_definition(patch, uv));
      std::vector<Vec3> points = random_points(random, 40, 40);
      points.insert(points.end(), {samples[4000], samples[0], samples.back()});
      const std::vector<Foot> feet = surface.closest(points);
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LE(feet[i].distance, sampled(samples, points[i]) + 1e-9);
        EXPECT_LT(glm::length(feet[i].point - shapes::by_definition(patch, feet[i].uv)), 1e-9);
        EXPECT_NEAR(glm::length(feet[i].point - points[i]), feet[i].distance, 1e-9);
      }
    }
}

TEST(SurfaceClosest, IsZeroOnTheSurface) {
  std::mt19937 random(6);
  for (int k = 0; k < 10; ++k) {
    const Patch patch = shapes::random_patch(random, 1 + k % 5, 1 + k % 4, 100);
    const Surface surface({patch});
    std::vector<Vec3> points;
    for (const SurfacePoint& s : surface.evaluate(shapes::grid(patch, 8))) points.push_back(s.point);
    for (const Foot& foot : surface.closest(points)) EXPECT_LE(foot.distance, 1e-9);
  }
}

TEST(SurfaceClosest, OfSeveralPatchesTakesTheNearest) {
  const Surface both({shapes::ball(2, 4, {-10, 0, 0}), shapes::ball(3, 4, {10, 0, 0})});
  const auto feet = both.closest(std::vector{Vec3(-1, 0, 0), Vec3(1, 0, 0)});
  EXPECT_EQ(feet[0].patch, 0U);
  EXPECT_EQ(feet[1].patch, 1U);
  EXPECT_NEAR(feet[0].distance, 7, 1e-9);
  EXPECT_NEAR(feet[1].distance, 6, 1e-9);
}

TEST(SurfaceClosest, RefusesPointsThatAreNotFinite) {
  const Surface surface({shapes::ball(1)});
  EXPECT_NE(error_of([&] { surface.closest(std::vector{Vec3(0), Vec3(0, std::nan(""), 0)}); }).find("points, row 1: "),
            std::string::npos);
  EXPECT_TRUE(surface.closest({}).empty());
}

}  // namespace
}  // namespace riffler::nurbs::closest_test
