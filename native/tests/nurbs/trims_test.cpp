// Borders of patches: what they enclose, and the nearest points within them, against closed forms.
#include <gtest/gtest.h>

#include <random>

#include "nurbs/bezier.hpp"
#include "nurbs/quadrics.hpp"
#include "nurbs/trim_region.hpp"
#include "nurbs/trimmed_net.hpp"
#include "riffler/nurbs/surface.hpp"
#include "support/error_of.hpp"

namespace riffler::nurbs::trims_test {
namespace {

using Loop = std::vector<Vec2>;

Patch plane(double size) {
  Patch patch;
  patch.count_u = patch.count_v = 2;
  patch.points = {{0, 0, 0}, {0, size, 0}, {size, 0, 0}, {size, size, 0}};
  patch.weights = {1, 1, 1, 1};
  patch.knots_u = patch.knots_v = {0, 0, 1, 1};
  return patch;
}

Loop circle(const Vec2& centre, double radius, int points) {
  Loop loop;
  for (int k = 0; k < points; ++k) {
    const double a = 2 * kPi * k / points;
    loop.push_back(centre + radius * Vec2(std::cos(a), std::sin(a)));
  }
  return loop;
}

double area(const Trapezoid& t) {
  return 0.5 * (t.high - t.low) * (t.right[0] - t.left[0] + t.right[1] - t.left[1]);
}

double area(const Loop& loop) {
  double sum = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec2 &a = loop[i], &b = loop[(i + 1) % loop.size()];
    sum += 0.5 * (a.x * b.y - a.y * b.x);
  }
  return std::abs(sum);
}

TEST(TrimRegion, IsDividedIntoTrapezoidsOfItsAreaThatAreInside) {
  const Loop outer = circle({0.5, 0.5}, 0.45, 101), hole = circle({0.6, 0.45}, 0.2, 64),
             island = circle({0.6, 0.45}, 0.1, 7);
  const TrimRegion region({outer, hole, island});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  double sum = 0;
  constexpr int kParts = 6;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j) {
      const Vec2 lower = Vec2(i, j) / double{kParts}, upper = Vec2(i + 1, j + 1) / double{kParts};
      const TrimRegion::Edges edges = region.touching(region.all(), lower, upper);
      if (edges.empty()) {
        sum += region.holds(0.5 * (lower + upper)) ? 1.0 / (kParts * kParts) : 0;
        continue;
      }
      std::vector<Trapezoid> pieces;
      region.append_pieces(edges, lower, upper, pieces);
      for (const Trapezoid& t : pieces) {
        sum += area(t) / (kParts * kParts);
        if (area(t) < 1e-9) continue;
        const Vec2 inner = t.at(Vec2(share(random), share(random)));
        EXPECT_TRUE(region.holds(lower + inner * (upper - lower)));
      }
    }
  EXPECT_NEAR(sum, area(outer) - area(hole) + area(island), 1e-12);
}

TEST(TrimRegion, AcceptsCurvesThatCrossThemselves) {
  const TrimRegion region({Loop{{0, 0}, {1, 1}, {1, 0}, {0, 1}}});  // two triangles
  std::vector<Trapezoid> pieces;
  region.append_pieces(region.all(), Vec2(0), Vec2(1), pieces);
  double sum = 0;
  for (const Trapezoid& t : pieces) sum += area(t);
  EXPECT_NEAR(sum, 0.5, 1e-14);
  EXPECT_FALSE(region.holds({0.5, 0.2}));
  EXPECT_TRUE(region.holds({0.2, 0.5}) && region.holds({0.8, 0.5}));
}

TEST(TrimmedNet, IsTheSameSurface) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (const auto& [p, q] : {std::pair{1, 1}, {2, 3}, {3, 2}, {5, 1}, {6, 7}}) {
    const Degrees degrees{p, q};
    std::vector<Vec4> net;
    for (std::size_t k = 0; k < degrees.size(); ++k) {
      const double w = 0.2 + share(random);
      net.emplace_back(w * Vec3(share(random), share(random), share(random)), w);
    }
    const double low = 0.3 * share(random), high = 0.5 + 0.5 * share(random);
    for (const Trapezoid& t :
         {Trapezoid{low, high, {0.1, 0.4}, {0.9, 0.4}}, Trapezoid{low, high, {0.2, 0.2}, {0.6, 0.6}},
          Trapezoid{low, high, {0, 0.3}, {0.7, 1}}}) {
      const Degrees made = degrees_over(degrees, t);
      std::vector<Vec4> trimmed(made.size());
      trimmed_net(net.data(), degrees, t, trimmed.data());
      for (int k = 0; k < 20; ++k) {
        const Vec2 at(share(random), share(random));
        EXPECT_LT(
            glm::length(affine(point_of(trimmed.data(), made, at)) - affine(point_of(net.data(), degrees, t.at(at)))),
            1e-14);
      }
    }
  }
}

TEST(TrimmedSurface, IgnoresBordersWithNothingNextToThem) {
  Patch patch = plane(20);
  const Loop square{{0.2, 0.2}, {0.5, 0.2}, {0.5, 0.5}, {0.2, 0.5}};
  Loop spike = square;
  spike.insert(spike.begin() + 3, {{0.8, 0.5}, {0.5, 0.5}});  // out and back
  patch.trims = {spike};
  EXPECT_NEAR(Surface({patch}).closest(std::vector{Vec3(16, 10, 1)})[0].distance, std::hypot(6, 1), 2e-9);
  patch.trims = {square, square, {{0.7, 0.7}, {0.9, 0.7}, {0.9, 0.9}, {0.7, 0.9}}};  // the first two enclose nothing
  EXPECT_NEAR(Surface({patch}).closest(std::vector{Vec3(6, 6, 1)})[0].distance, std::hypot(8, 8, 1), 2e-9);
}

TEST(TrimmedSurface, HasTheNearestPointOfBordersWithNoise) {
  // A roller of radius 6 around z, whose upper border differs from z = 9 by 1e-12 mm.
  Patch patch = shapes::turned(shapes::line({6, -5}, {6, 9}), 4);
  const Vec2 lower = patch.lower(), upper = patch.upper();
  const Surface whole({patch});
  const double first = whole.evaluate(std::vector{lower})[0].point.z;
  const double along = whole.evaluate(std::vector{Vec2(upper.x, lower.y)})[0].point.z == first ? 1 : 0;
  Loop loop;
  const auto at = [&](double around, double up) {
    return lower + (upper - lower) * (along > 0 ? Vec2(around, up) : Vec2(up, around));
  };
  for (int k = 0; k <= 40; ++k) loop.push_back(at(k / 40.0, 1 - 1e-13 * (k % 3)));
  loop.push_back(at(1, 0)), loop.push_back(at(0, 0));
  patch.trims = {loop};
  const Surface surface({patch});
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 100; ++k) {
    const double a = 2 * kPi * share(random), off = 0.002 * share(random), up = 0.002 * share(random) - 0.001;
    for (const double end : {-5.0, 9.0}) {
      const Vec3 p((6 + off) * std::cos(a), (6 + off) * std::sin(a), end + up);
      const double beyond = std::max(0.0, end > 0 ? up : -up);
      EXPECT_NEAR(surface.closest(std::vector{p})[0].distance, std::hypot(off, beyond), 2e-9) << a << " " << end;
    }
  }
}

TEST(TrimmedSurface, HasTheNearestPointWithinItsBorders) {
  Patch patch = plane(20);
  const Loop outer = circle({0.5, 0.5}, 0.4, 90), hole = circle({0.5, 0.5}, 0.2, 45);
  patch.trims = {outer, hole};
  const Surface surface({patch});
  const auto to_loop = [](const Loop& loop, const Vec2& p) {
    double least = 1e9;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 a = 20.0 * loop[i], b = 20.0 * loop[(i + 1) % loop.size()];
      const double t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
      least = std::min(least, glm::length(p - a - t * (b - a)));
    }
    return least;
  };
  std::mt19937 random(2);
  std::uniform_real_distribution<double> share(-5, 25);
  std::vector<Vec3> points;
  for (int k = 0; k < 200; ++k) points.emplace_back(share(random), share(random), 0.3 * share(random));
  points.emplace_back(10, 10, 0), points.emplace_back(10, 10, 5);
  const std::vector<Foot> feet = surface.closest(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 p(points[i]);
    const std::vector<char> inside = surface.inside(std::vector{glm::clamp(p / 20.0, 0.0, 1.0)});
    const bool within = glm::clamp(p, 0.0, 20.0) == p && inside[0];
    const double flat = within ? 0 : std::min(to_loop(outer, p), to_loop(hole, p));
    EXPECT_NEAR(feet[i].distance, std::hypot(flat, points[i].z), 2e-9) << i;
  }
}

TEST(TrimmedSurface, IsCutThroughSeamsAndPoles) {
  // A ball without a cap around x: u runs around z, so the border passes the seam and, if the cap is large, the poles.
  for (const double half : {0.4, 1.2, 1.9}) {
    Patch patch = shapes::ball(7);
    Loop loop;
    // In (u, v) the border is found from points of the circle by closest; its two ends meet at the seam.
    const Surface whole({patch});
    std::vector<Vec3> ring;
    constexpr int kPoints = 720;
    for (int k = 0; k < kPoints; ++k) {
      const double a = 2 * kPi * (k + 0.5) / kPoints;
      ring.push_back(7.0 * Vec3(std::cos(half), std::sin(half) * std::cos(a), std::sin(half) * std::sin(a)));
    }
    // The cap is around −x here (u in the middle of the domain), where it is far from the seam at +x.
    for (Vec3& p : ring) p.x = -p.x;
    for (const Foot& f : whole.closest(ring)) loop.push_back(f.uv);
    if (half < 0.5 * kPi) patch.trims = {loop};
    if (patch.trims.empty()) continue;
    const Surface cap({patch});
    std::mt19937 random(4);
    std::uniform_real_distribution<double> share(-10, 10);
    std::vector<Vec3> points;
    for (int k = 0; k < 100; ++k) points.emplace_back(share(random), share(random), share(random));
    points.emplace_back(-1e-3, 0, 0);
    const std::vector<Foot> feet = cap.closest(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& p = points[i];
      const double along = -p.x, beside = std::hypot(p.y, p.z), angle = std::atan2(beside, along);
      const Vec2 rim = 7.0 * Vec2(std::cos(half), std::sin(half));
      const double expected = angle <= half ? std::abs(glm::length(p) - 7) : glm::length(Vec2(along, beside) - rim);
      EXPECT_NEAR(feet[i].distance, expected, 3e-4) << half << " " << i;  // chords of the border
    }
  }
}

TEST(TrimmedSurface, HasAMeshWithinTheTolerance) {
  Patch patch = shapes::torus(10, 3);
  const Vec2 size = patch.upper() - patch.lower();
  patch.trims = {circle(0.5 * size, 0.3 * size.x, 200)};
  const Surface surface({patch});
  for (const double tolerance : {0.1, 0.003}) {
    const Mesh mesh = surface.to_mesh(tolerance);
    ASSERT_FALSE(mesh.triangles.empty());
    for (const Vec3i& t : mesh.triangles) {
      const Vec3 middle = (mesh.vertices[t.x] + mesh.vertices[t.y] + mesh.vertices[t.z]) / 3.0;
      const double off = std::abs(glm::length(Vec2(std::hypot(middle.x, middle.y) - 10, middle.z)) - 3);
      EXPECT_LE(off, tolerance);
    }
    for (const Vec3& v : mesh.vertices) EXPECT_LT(surface.closest(std::vector{v})[0].distance, 1e-9);
  }
}

TEST(TrimmedSurface, NamesErrorsInItsBorders) {
  const auto error = [](const std::vector<Loop>& trims) {
    Patch patch = plane(1);
    patch.trims = trims;
    return test::error_of([&] { Surface({patch}); });
  };
  EXPECT_NE(error({{{0, 0}, {1, 1}}}).find("trims, loop 0 has 2 points"), std::string::npos);
  EXPECT_NE(
      error({circle({0.5, 0.5}, 0.2, 9), {{0, 0}, {1, 0}, {1, 1.5}}}).find("trims, loop 1, row 2: (1, 1.5) is not"),
      std::string::npos);
  EXPECT_NE(error({{{0, 0}, {0.5, 0.5}, {1, 1}}}).find("nothing is inside"), std::string::npos);
}

}  // namespace
}  // namespace riffler::nurbs::trims_test
