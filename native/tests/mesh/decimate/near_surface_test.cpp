// Whether a triangle counts as near, compared with dense samples.
#include "mesh/decimate/near_surface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace riffler::mesh::near_surface_test {
namespace {

/// Thin faces around one corner of a square, in the plane z = 0.
std::vector<Corners> needles(int n) {
  std::vector<Corners> fan;
  for (int k = 0; k < n; ++k)
    fan.push_back({Vec3(0, 0, 0), Vec3(10, 10.0 * k / n, 0), Vec3(10, 10.0 * (k + 1) / n, 0)});
  return fan;
}

TEST(NearSurface, HandlesDegeneratePlaces) {
  const NearSurface surface(needles(3), 0.01);
  const Vec3 p(5, 1, 0);
  EXPECT_TRUE(surface.holds({p, p, p}, 10));
  EXPECT_TRUE(surface.holds({p, p + Vec3(1, 0, 0), p + Vec3(2, 0, 0)}, 100));
  EXPECT_FALSE(surface.holds({p + Vec3(0, 0, 1), p + Vec3(0, 0, 1), p + Vec3(0, 0, 1)}, 100));
  EXPECT_FALSE(surface.holds({p, p, p}, 0));  // no pieces left
  const NearSurface point({{p, p, p}}, 0.01);
  EXPECT_TRUE(point.holds({p, p, p}, 10));
  EXPECT_FALSE(point.holds({p, p + Vec3(0.1, 0, 0), p + Vec3(0, 0.1, 0)}, 1000));
}

TEST(NearSurface, ATriangleOverThinFacesTakesFewPieces) {
  const Corners place{Vec3(1, 0.1, 0), Vec3(9.9, 0.5, 0), Vec3(9.5, 9, 0)};
  for (const int n : {10, 100, 400}) {
    for (const double tolerance : {0.01, 1e-6}) {
      const NearSurface surface(needles(n), tolerance);
      EXPECT_TRUE(surface.holds(place, 4 * n + 100)) << n;
      Corners off = place;
      for (Vec3& p : off) p.z += 0.9 * tolerance;
      EXPECT_TRUE(surface.holds(off, 4 * n + 100)) << n;
      for (Vec3& p : off) p.z += 0.2 * tolerance;
      EXPECT_FALSE(surface.holds(off, 100 * n)) << n;
      off = place;
      off[0].y -= 3;  // next to the square
      EXPECT_FALSE(surface.holds(off, 100 * n)) << n;
    }
  }
}

/// Distance from the nearest of some triangles.
double distance(const std::vector<Corners>& surface, const Vec3& p) {
  double best = 1e300;
  for (const Corners& t : surface)
    best = std::min(best, glm::length(p - closest_on_triangle(p, t[0], t[1], t[2]).point));
  return best;
}

TEST(NearSurface, NeverCallsAFarPlaceNear) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1, 1);
  const auto any = [&] { return Vec3(part(random), part(random), part(random)); };
  int near = 0, far = 0;
  for (int k = 0; k < 600; ++k) {
    // A rough sheet of two triangles to a square, and a place over it.
    std::vector<Vec3> grid;
    const double rough = 0.2 * std::abs(part(random)), tolerance = 0.02 + 0.1 * std::abs(part(random));
    for (int i = 0; i < 25; ++i) grid.push_back(Vec3(i % 5, i / 5, 0) + rough * any());
    std::vector<Corners> surface;
    for (int i = 0; i < 20; ++i) {
      if (i % 5 == 4) continue;
      surface.push_back({grid[i], grid[i + 1], grid[i + 6]});
      surface.push_back({grid[i], grid[i + 6], grid[i + 5]});
    }
    Corners place;
    for (Vec3& p : place) p = Vec3(2, 2, 0) + any() * Vec3(2.05, 2.05, 0.6 * tolerance);
    const bool holds = NearSurface(surface, tolerance).holds(place, 3000);
    double worst = 0;
    for (int i = 0; i <= 30; ++i)
      for (int j = 0; i + j <= 30; ++j)
        worst = std::max(
            worst, distance(surface, (place[0] * (30.0 - i - j) + place[1] * (1.0 * i) + place[2] * (1.0 * j)) / 30.0));
    if (holds) {
      EXPECT_LE(worst, tolerance * (1 + 1e-6)) << k;
    }
    if (worst < 0.9 * tolerance) {
      EXPECT_TRUE(holds) << k;
    }
    (holds ? near : far) += 1;
  }
  EXPECT_GT(near, 50);
  EXPECT_GT(far, 50);
}

}  // namespace
}  // namespace riffler::mesh::near_surface_test
