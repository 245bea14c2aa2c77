// Spheres and cylinders against signed distances, at the degenerate limits.
#include "riffler/dexel/quadrics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "geom/math.hpp"

namespace riffler::dexel::quadrics_test {
namespace {

/// mm: by 0.25 · 5e-10 rays stand off their places, and doubles of 1e5 are 1.5e-11 apart.
constexpr double kOff = 3e-10;

using Distance = std::function<double(const Vec3&)>;

/// Largest distance of an end from the surface, mm; the middle of every span is inside.
double worst_end(const Volume& volume, const Distance& distance) {
  double worst = 0;
  for (const Grid& grid : volume.grids())
    for (int i = 0; i < grid.nu(); ++i)
      for (int j = 0; j < grid.nv(); ++j)
        for (const Span& span : grid.ray(i, j)) {
          const auto at = [&](double w) { return distance(to_world(grid.axis(), {grid.u(i), grid.v(j), w})); };
          worst = std::max({worst, std::abs(at(span.near)), std::abs(at(span.far))});
          EXPECT_LT(at(0.5 * (span.near + span.far)), 0);
        }
  return worst;
}

Distance distance_of(const Cylinder& c) {
  const Vec3 axis = glm::normalize(c.axis);
  return [c, axis](const Vec3& p) {
    const double along = glm::dot(p - c.centre, axis);
    return std::max(glm::length(p - c.centre - along * axis) - c.radius, std::abs(along) - 0.5 * c.height);
  };
}

TEST(Quadrics, EndsOfASphereLieOnIt) {
  for (const Vec3 centre : {Vec3(0), Vec3(0.3, -0.1, 7), Vec3(1e5, -1e5, 1e5)})
    for (const double radius : {2.0, 2.25, 5.1}) {
      const Sphere ball{centre, radius};
      const Volume volume = sphere(ball, {bounds(ball), 0.25, "xyz"});
      EXPECT_LT(worst_end(volume, [&](const Vec3& p) { return glm::length(p - centre) - radius; }), kOff);
    }
}

TEST(Quadrics, EndsOfACylinderLieOnItForAnyAxis) {
  for (const Vec3 axis : {Vec3(0, 0, 1), Vec3(0, -2, 0), Vec3(1, 2, 3), Vec3(1e-12, 0, 1), Vec3(1, 1e-17, 0),
                          Vec3(1e-200, 0, 1), Vec3(1, -1, 1e-300), Vec3(3, 0, 1e-9)})
    for (const Vec3 centre : {Vec3(0), Vec3(1e5, 0.1, -1e5)}) {
      const Cylinder bar{centre, 2, 5, axis};
      const Volume volume = cylinder(bar, {bounds(bar), 0.25, "xyz"});
      EXPECT_LT(worst_end(volume, distance_of(bar)), kOff);
      EXPECT_NEAR(volume.volume(), kPi * 4 * 5, 0.05 * kPi * 4 * 5);
    }
}

/// Rays at 0.5, 1.5, …: of a radius of 2.5 some run in the side of a cylinder along them, to the last bit.
TEST(Quadrics, RaysInTheSideAreInOrOutAndNothingBetween) {
  const Cylinder bar{{0, 0, 0}, 2.5, 4};
  const Volume volume = cylinder(bar, {{Vec3(-4), Vec3(4)}, 1, "xyz"});
  const Grid& z = *volume.grid(Axis::Z);
  for (int i = 0; i < z.nu(); ++i)
    for (int j = 0; j < z.nv(); ++j) {
      const double d = std::hypot(z.u(i), z.v(j));
      if (std::abs(d - 2.5) > 1e-6) {
        EXPECT_EQ(z.ray(i, j).size(), d < 2.5);
      }
      for (const Span& span : z.ray(i, j)) EXPECT_EQ(span, (Span{-2, 2}));
    }
}

TEST(Quadrics, RefuseInvalidInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan, kInfinity}) {
    EXPECT_THROW(bounds(Sphere{{0, 0, 0}, bad}), std::invalid_argument);
    EXPECT_THROW(bounds(Cylinder{{0, 0, 0}, bad, 1}), std::invalid_argument);
    EXPECT_THROW(bounds(Cylinder{{0, 0, 0}, 1, bad}), std::invalid_argument);
  }
  EXPECT_THROW(bounds(Sphere{{0, nan, 0}, 1}), std::invalid_argument);
  EXPECT_THROW(bounds(Sphere{{1e9, 0, 0}, 1e-9}), std::invalid_argument);
  EXPECT_THROW(bounds(Sphere{{1e308, 0, 0}, 1.7e308}), std::invalid_argument);
  EXPECT_THROW(bounds(Cylinder{{0, 0, 0}, 1, 1, {0, 0, 0}}), std::invalid_argument);
  EXPECT_THROW(bounds(Cylinder{{0, 0, 0}, 1, 1, {0, nan, 0}}), std::invalid_argument);
  EXPECT_THROW(sphere({{0, 0, 0}, 0.1}, {{Vec3(-4), Vec3(4)}, 1, "z"}), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::dexel::quadrics_test
