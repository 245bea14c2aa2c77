#include "riffler/plan/swarf.hpp"
#include "geom/math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "mesh/closest.hpp"
#include "riffler/tool/cutters.hpp"
#include "support/effort.hpp"

namespace riffler::plan::swarf_test {
namespace {

/// A sheet over [0, 1]² in (nu × nv) cells; its normals look along ∂u × ∂v.
Mesh sheet(const std::function<Vec3(double, double)>& at, int nu, int nv) {
  Mesh mesh;
  for (int i = 0; i <= nu; ++i)
    for (int j = 0; j <= nv; ++j) mesh.vertices.push_back(at(double(i) / nu, double(j) / nv));
  for (int i = 0; i < nu; ++i)
    for (int j = 0; j < nv; ++j) {
      const int a = i * (nv + 1) + j, b = a + nv + 1;
      mesh.triangles.push_back({a, b, b + 1}), mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

/// Points of a path along x at a wall through the x axis that leans back by `draft`, above a floor far away.
PencilPath straight_path(double radius, double draft, int points) {
  PencilPath path;
  path.radius = radius;
  const Vec3 wall{0, -std::cos(draft), std::sin(draft)};
  // The ball touches the floor z = 0 and the wall.
  const double y = (radius * std::sin(draft) - radius) / std::cos(draft);
  for (int k = 0; k < points; ++k) {
    const Vec3 centre{10.0 + k, y, radius};
    path.centres.push_back(centre);
    path.contacts.push_back({centre - radius * wall, centre - Vec3(0, 0, radius)});
    path.normals.push_back({wall, Vec3(0, 0, 1)});
  }
  return path;
}

/// About a wall of revolution whose radius at height z is `wall(z)`, on the floor z = 0; `slope` is its derivative at
/// the contact.
PencilPath ring_path(double radius, double from_axis, const Vec2& wall_normal, int points) {
  PencilPath path;
  path.radius = radius, path.closed = true;
  for (int k = 0; k < points; ++k) {
    const double t = 2 * kPi * k / points;
    const Vec3 out{std::cos(t), std::sin(t), 0}, normal = wall_normal.x * out + Vec3(0, 0, wall_normal.y);
    const Vec3 centre = from_axis * out + Vec3(0, 0, radius);
    path.centres.push_back(centre);
    path.contacts.push_back({centre - radius * normal, centre - Vec3(0, 0, radius)});
    path.normals.push_back({normal, Vec3(0, 0, 1)});
  }
  return path;
}

TEST(Swarf, TheAxisLiesAlongAPlaneWallAndStraightUp) {
  for (const double draft : {0.0, 0.1, 0.4}) {
    const Vec3 up{0, std::sin(draft), std::cos(draft)};
    const Mesh wall = sheet([&](double u, double v) { return Vec3(100 * u, 0, 0) + 25 * v * up; }, 3, 2);
    const Swarf found = swarf(straight_path(3, draft, 60), wall, cutters::ball(6, 20));
    ASSERT_EQ(found.fits.size(), 1u);
    EXPECT_EQ(found.fits[0][1], 59u);
    for (std::size_t k = 0; k < 60; ++k) {
      EXPECT_LT(glm::length(found.path.axes[k] - up), 1e-6);
      EXPECT_LT(found.error[k], 1e-6);
    }
  }
}

TEST(Swarf, AConeIsTouchedAlongItsRulings) {
  const double lean = 0.25, foot = 12, height = 20, radius = 3;
  const Mesh cone = sheet(
      [&](double u, double v) {
        const double r = foot - v * height * std::tan(lean), t = 2 * kPi * u;
        return Vec3(r * std::cos(t), r * std::sin(t), v * height);
      },
      1440, 1);
  const double from_axis = foot - radius * std::tan(lean) + radius / std::cos(lean);
  const PencilPath path = ring_path(radius, from_axis, {std::cos(lean), std::sin(lean)}, test::cases(90, 2));
  const Swarf found = swarf(path, cone, cutters::ball(6, 20));
  const double facets = foot * (1 - std::cos(kPi / 1440));
  for (std::size_t k = 0; k < path.size(); ++k) {
    const Vec3 out = glm::normalize(Vec3(path.centres[k].x, path.centres[k].y, 0));
    EXPECT_LT(glm::length(found.path.axes[k] + std::sin(lean) * out - Vec3(0, 0, std::cos(lean))), 2e-3);
    EXPECT_LT(found.error[k], 2 * facets);
  }
  ASSERT_EQ(found.fits.size(), 1u);
}

TEST(Swarf, RulingsThatLeanAlongTheFeedAreFound) {
  // A cylinder of radius 40 that leans by 0.5 rad along the feed: its only straight lines lean so.
  const double lean = 0.5, radius = 3, wide = 40;
  const Vec3 along{std::sin(lean), 0, std::cos(lean)};
  const Vec3 across = Vec3(std::cos(lean), 0, -std::sin(lean));
  const Mesh wall = sheet(
      [&](double u, double v) {
        const double t = 0.6 * (u - 0.5);
        return wide * (std::sin(t) * across + (1 - std::cos(t)) * Vec3(0, 1, 0)) + (60 * v - 20) * along;
      },
      2000, 1);
  PencilPath path;
  path.radius = radius;
  for (int k = -2; k <= 2; ++k) {
    const double t = 0.03 * k;
    const Vec3 normal = -std::cos(t) * Vec3(0, 1, 0) + std::sin(t) * across;
    const Vec3 contact = wide * (std::sin(t) * across + (1 - std::cos(t)) * Vec3(0, 1, 0));
    path.centres.push_back(contact + radius * normal);
    path.contacts.push_back({contact, contact}), path.normals.push_back({normal, along});
  }
  const Swarf found = swarf(path, wall, cutters::ball(6, 20));
  for (std::size_t k = 0; k < path.size(); ++k) {
    EXPECT_LT(glm::length(found.path.axes[k] - along), 0.03) << k;
    EXPECT_LT(found.error[k], 2e-3);
  }
}

TEST(Swarf, AWallThatBulgesIsNotCutByAStraightFlank) {
  // Radius 30 in the meridian too: over 17 mm a straight flank is off by a tenth of a mm and more.
  const Mesh wall = sheet(
      [&](double u, double v) {
        const double z = 24 * v, r = 12 + std::sqrt(900 - (z - 12) * (z - 12)) - 30, t = 2 * kPi * u;
        return Vec3(r * std::cos(t), r * std::sin(t), z);
      },
      360, 240);
  const double angle = std::asin(9.0 / 33);  // of the normal at the ball that touches the floor, below the equator
  const PencilPath path = ring_path(3, -18 + 33 * std::cos(angle), {std::cos(angle), -std::sin(angle)}, 40);
  const Swarf found = swarf(path, wall, cutters::ball(6, 20));
  EXPECT_TRUE(found.fits.empty());
  const mesh::Closest closest(wall);
  for (std::size_t k = 0; k < path.size(); ++k) {
    EXPECT_GT(found.height[k], 11);
    double dense = 0;
    for (int j = 0; 0.01 * j <= found.height[k]; j += test::kSanitized ? 10 : 1)
      dense = std::max(dense, std::abs(closest(path.centres[k] + 0.01 * j * found.path.axes[k]).distance - 3));
    EXPECT_GT(found.error[k], 0.9 * dense);
    EXPECT_GT(dense, 0.1);
  }
}

TEST(Swarf, NoPoseIsLeftWhereTheWallEnds) {
  const Mesh wall = sheet([](double u, double v) { return Vec3(30 * u, 0, 25 * v); }, 3, 2);
  const Swarf found = swarf(straight_path(3, 0, 60), wall, cutters::ball(6, 20));
  ASSERT_EQ(found.fits.size(), 1u);
  EXPECT_EQ(found.fits[0][0], 0u);
  EXPECT_GE(found.fits[0][1], 20u);  // x = 30
  EXPECT_LE(found.fits[0][1], 21u);
  EXPECT_GT(found.error[50], 1.0);
}

TEST(Swarf, BadInputIsNamed) {
  const Mesh wall = sheet([](double u, double v) { return Vec3(100 * u, 0, 25 * v); }, 1, 1);
  const PencilPath path = straight_path(3, 0, 5);
  EXPECT_THROW(swarf(path, wall, cutters::ball(5, 20)), std::invalid_argument);
  EXPECT_THROW(swarf(path, wall, cutters::flat(6, 20)), std::invalid_argument);
  EXPECT_THROW(swarf(path, wall, cutters::ball(6, 20), {.side = 2, .height = {}}), std::invalid_argument);
  EXPECT_THROW(swarf(path, wall, cutters::ball(6, 20), {.height = 18.0}), std::invalid_argument);
  EXPECT_THROW(swarf(path, Mesh{}, cutters::ball(6, 20)), std::invalid_argument);
  EXPECT_THROW(swarf(PencilPath{}, wall, cutters::ball(6, 20)), std::invalid_argument);
}

}  // namespace
}  // namespace riffler::plan::swarf_test
