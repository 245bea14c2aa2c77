// Contact with exact surfaces against closed forms, and against fine triangles where there is no closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>

#include "collide/tools.hpp"
#include "nurbs/quadrics.hpp"
#include "riffler/collide/collider.hpp"
#include "support/effort.hpp"

namespace riffler::collide::exact_collider_test {
namespace {

namespace shapes = nurbs::shapes;

constexpr double kExact = 1e-6;  // mm

/// How many poses: a few in the check, more with RIFFLER_LONG.
int count(int few, int many) {
  return std::getenv("RIFFLER_LONG") ? many : few;
}

/// For tests that look at distances only.
Collider::Settings few_points() {
  Collider::Settings settings;
  settings.spacing = 1;
  return settings;
}

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> share;
  return glm::normalize(Vec3(share(random), share(random), share(random)));
}

double to_torus(const Vec3& p) {
  return glm::length(Vec2(std::hypot(p.x, p.y) - 20, p.z)) - 5;
}

TEST(ExactCollider, HasTheClearanceOfABallFromATorusInClosedForm) {
  Collider::Settings settings;
  settings.spacing = 0.2;  // distances are exact for any
  const Collider collider(Surface({shapes::torus(20, 5)}), {}, settings);
  const Tool ball = cutters::ball(6, 30);
  const Assembly assembly(ball);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-0.5, 2);
  for (int k = 0; k < test::cases(60, 15); ++k) {
    // The ball's centre on the outward normal of the torus, the axis away from it: nothing but the ball is near.
    const double a = 6.3 * share(random), b = 6.3 * share(random), depth = share(random);
    const Vec3 ring(std::cos(a), std::sin(a), 0), normal = std::cos(b) * ring + Vec3(0, 0, std::sin(b));
    const Vec3 centre = 20.0 * ring + (5 + 3 - depth) * normal;
    if (std::cos(b) < 0.2) continue;  // the axis would cross the hole
    const Pose pose{centre - 3.0 * normal, normal};
    EXPECT_NEAR(collider.clearance(assembly, pose), -depth, kExact) << k;
    if (depth <= 0) continue;
    const Contact contact = collider.query(assembly, pose);
    EXPECT_NEAR(contact.depth, depth, kExact);
    EXPECT_LE(contact.missed_depth_bound, kExact);
    EXPECT_LT(std::abs(to_torus(contact.points[0])), 1e-9);
    EXPECT_GT(glm::dot(contact.force, normal), 0.99 * glm::length(contact.force));
  }
}

TEST(ExactCollider, FeelsNoFacetsAlongATorus) {
  const Surface torus({shapes::torus(20, 5)});
  const Collider exact(torus), flat(torus.to_mesh(0.01));
  const Assembly assembly(cutters::ball(6, 30));
  const auto ripple = [&](const Collider& collider) {
    double least = 1e9, most = 0;
    for (int k = 0; k < 200; k += 200 / test::cases(200, 10)) {
      const double a = 0.8 + 1e-3 * k, b = 0.3;
      const Vec3 ring(std::cos(a), std::sin(a), 0), normal = std::cos(b) * ring + Vec3(0, 0, std::sin(b));
      const double force = glm::length(collider.query(assembly, {20.0 * ring + (5 - 0.1) * normal, normal}).force);
      least = std::min(least, force), most = std::max(most, force);
    }
    return (most - least) / (most + least);
  };
  EXPECT_LE(ripple(exact), 1e-3);
  EXPECT_GT(ripple(flat), 5e-3);
}

TEST(ExactCollider, SumsTheForceInClosedForm) {
  // A ball of radius R whose centre is at the distance R - d from a plane: k d³ π / 3 (3 R − d) / … by integration of
  // depth R − √(c² + r²) over the disc, c = R − d.
  nurbs::Patch plane;
  plane.count_u = plane.count_v = 2;
  plane.points = {{-10, -10, 0}, {-10, 10, 0}, {10, -10, 0}, {10, 10, 0}};
  plane.weights = {1, 1, 1, 1};
  plane.knots_u = plane.knots_v = {0, 0, 1, 1};
  const Collider collider(Surface({plane}));
  const Assembly assembly(cutters::ball(6, 30));
  for (const double d : {0.01, 0.1, 0.5}) {
    const double c = 3 - d, rr = 9 - c * c;
    const double expected = kPi * (3 * rr - 2.0 / 3 * (27 - c * c * c));
    const Contact contact = collider.query(assembly, {{0.37, -0.21, -d}, {0, 0, 1}});
    EXPECT_NEAR(contact.force.z, expected, 2e-3 * expected) << d;
    EXPECT_NEAR(contact.depth, d, kExact);
  }
}

TEST(ExactCollider, AgreesWithFineTrianglesForEveryTool) {
  const Surface surface(
      {shapes::torus(20, 5), shapes::ball(6, 4, {0, 0, 3}), shapes::turned(shapes::line({30, -8}, {24, 12}))});
  constexpr double kFine = 5e-3;
  const Collider exact(surface, {}, few_points()), fine(surface.to_mesh(kFine), {}, few_points());
  std::mt19937 random(8);
  std::uniform_real_distribution<double> share(-30, 30);
  for (const Tool& tool : contact_tools()) {
    const Assembly assembly(tool);
    for (int k = 0; k < count(2, 20); ++k) {
      const Pose pose{{share(random), share(random), 0.5 * share(random)}, direction(random)};
      const double a = exact.nearest(assembly, pose, 1e-4).distance, b = fine.nearest(assembly, pose, 1e-4).distance;
      EXPECT_NEAR(a, b, kFine + 2.2e-4) << tool.length() << " " << k;
    }
  }
}

TEST(ExactCollider, KeepsToTheBordersOfPatches) {
  // A plate with a round hole: the tool goes through it without contact.
  nurbs::Patch plate;
  plate.count_u = plate.count_v = 2;
  plate.points = {{-10, -10, 0}, {-10, 10, 0}, {10, -10, 0}, {10, 10, 0}};
  plate.weights = {1, 1, 1, 1};
  plate.knots_u = plate.knots_v = {0, 0, 1, 1};
  std::vector<Vec2> hole;
  constexpr int kPoints = 2000;
  for (int k = 0; k < kPoints; ++k) {
    const double a = 2 * kPi * k / kPoints;
    hole.emplace_back(0.5 + 0.2 * std::cos(a), 0.5 + 0.2 * std::sin(a));
  }
  plate.trims = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}, hole};
  const Collider collider(Surface({plate}), {}, few_points());
  const Assembly assembly(cutters::flat(6, 30));
  for (const double x : {0.0, 0.4, 0.9})
    EXPECT_NEAR(collider.clearance(assembly, {{x, 0, -5}, {0, 0, 1}}), 4 * std::cos(kPi / kPoints) - 3 - x, 1e-5) << x;
  EXPECT_NEAR(collider.clearance(assembly, {{0, 0, 2}, {0, 0, 1}}), std::hypot(1, 2), 1e-5);
}

/// Smallest distance of a surface from a segment, by the proven nearest points of ever closer places on it.
double to_segment(const Surface& surface, const Vec3& from, const Vec3& to) {
  double low = 0, high = 1, least = 1e9;
  for (int round = 0; round < 4; ++round) {
    constexpr int kPlaces = 30;
    std::vector<Vec3> places;
    for (int k = 0; k <= kPlaces; ++k) places.push_back(from + (low + (high - low) * k / kPlaces) * (to - from));
    const std::vector<nurbs::Foot> feet = surface.closest(places);
    int best = 0;
    for (int k = 0; k <= kPlaces; ++k)
      if (feet[k].distance < feet[best].distance) best = k;
    least = std::min(least, feet[best].distance);
    const double step = (high - low) / kPlaces, at = low + best * step;
    low = std::max(0.0, at - 1.5 * step), high = std::min(1.0, at + 1.5 * step);
  }
  return least;
}

TEST(ExactCollider, AgreesWithNearestPointsOnWavyPatches) {
  // A ball with a shank of its radius is all that is near a segment. Weights differ by 10⁶, and knots are multiple.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  const double radius = 1.5, length = 12;
  const Assembly assembly(cutters::ball(2 * radius, length));
  int checked = 0;
  for (const int degree : {1, 2, 3, 5}) {
    nurbs::Patch patch = shapes::random_patch(random, degree, 1 + degree / 2, 1e3);
    if (degree < 5) {  // borders through all of it
      const Vec2 lower = patch.lower(), size = patch.upper() - lower;
      patch.trims = {{lower + 0.1 * size, lower + Vec2(0.9, 0.2) * size, lower + Vec2(0.6, 0.95) * size}};
    }
    const Surface surface({patch});
    const Collider collider(surface, {}, few_points());
    const Box3 box = surface.bounds();
    for (int k = 0; k < count(test::cases(3), 30); ++k) {
      const Vec3 p = box.lower + Vec3(share(random), share(random), share(random)) * box.size();
      const Pose pose{p, direction(random)};
      const Vec3 centre = p + radius * pose.axis, top = p + length * pose.axis;
      const double expected = to_segment(surface, centre, top) - radius;
      if (expected < 1e-3 || surface.closest(std::vector{top})[0].distance < expected + radius + 1e-3) continue;
      EXPECT_NEAR(collider.clearance(assembly, pose), expected, kExact) << degree << " " << k;
      ++checked;
    }
  }
  EXPECT_GT(checked, test::kSanitized ? 0 : 3);
}

TEST(ExactCollider, EndsWhereABallLiesInAGrooveOfItsRadius) {
  const Collider collider(Surface({shapes::turned(shapes::line({3, 0}, {3, 20}))}), {}, few_points());
  const Assembly assembly(cutters::ball(6, 30));
  const Contact contact = collider.query(assembly, {{0, 0, 5}, {0, 0, 1}}, 0.01);
  EXPECT_NEAR(contact.depth, 0, 1e-5);
  const Contact deeper = collider.query(assembly, {{0.1, 0, 5}, {0, 0, 1}}, 0.01);
  EXPECT_NEAR(deeper.depth, 0.1, 1e-3);
  EXPECT_GE(deeper.depth + deeper.missed_depth_bound, 0.1 - kExact);
}

}  // namespace
}  // namespace riffler::collide::exact_collider_test
