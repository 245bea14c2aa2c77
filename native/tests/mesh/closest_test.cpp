#include "mesh/closest.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>

#include "mesh/shapes.hpp"

namespace riffler::mesh::closest_test {
namespace {

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double l2 = glm::dot(b - a, b - a);
  const double t = l2 > 0 ? std::fmin(1, std::fmax(0, glm::dot(p - a, b - a) / l2)) : 0;
  return glm::length(p - (a + t * (b - a)));
}

/// From the barycentric coordinates of the foot of the perpendicular, by Cramer's rule, or else from the three edges.
double triangle_distance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, w = p - a;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), wu = glm::dot(w, u), wv = glm::dot(w, v);
  const double det = uu * vv - uv * uv;
  if (det > 1e-14 * uu * vv) {
    const double s = (wu * vv - wv * uv) / det, t = (wv * uu - wu * uv) / det;
    if (s >= 0 && t >= 0 && s + t <= 1) return glm::length(w - s * u - t * v);
  }
  return std::fmin(segment_distance(p, a, b), std::fmin(segment_distance(p, b, c), segment_distance(p, c, a)));
}

double slow_distance(const Vec3& p, const Mesh& mesh) {
  double best = std::numeric_limits<double>::infinity();
  for (const Vec3i& t : mesh.triangles)
    best = std::fmin(best, triangle_distance(p, mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]));
  return best;
}

TEST(Closest, GathersAllTrianglesThatAreNearAndFindsTheNearestThatRisesAboveAPlane) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-20, 20);
  Mesh mesh = torus_mesh(10, 4, 40, 30);
  mesh.triangles.emplace_back(3, 3, 400);  // without area: it counts however it is turned
  const Closest closest(mesh);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p{coordinate(random), coordinate(random), coordinate(random)};
    const double limit = closest(p).distance + std::abs(coordinate(random)) / 4;
    const Vec3 origin{coordinate(random) / 4, coordinate(random) / 4, 0};
    const Vec3 up = glm::normalize(Vec3{coordinate(random), coordinate(random), coordinate(random)});
    std::vector<Closest::Hit> hits;
    closest.gather(p, limit, hits);
    std::vector<double> truth(mesh.triangles.size());
    std::size_t near = 0;
    double above = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3 &a = mesh.vertices[mesh.triangles[t].x], &b = mesh.vertices[mesh.triangles[t].y],
                 &c = mesh.vertices[mesh.triangles[t].z];
      truth[t] = triangle_distance(p, a, b, c);
      near += truth[t] <= limit ? 1 : 0;
      const Vec3 n = glm::cross(b - a, c - a);
      const double rise = std::max({glm::dot(a - origin, up), glm::dot(b - origin, up), glm::dot(c - origin, up)});
      if (rise > 0.5 && glm::dot(n, up) <= 0.3 * glm::length(n)) above = std::min(above, truth[t]);
    }
    EXPECT_EQ(hits.size(), near);
    for (const Closest::Hit& hit : hits) EXPECT_NEAR(hit.distance, truth[hit.triangle], 1e-12);
    const Closest::Hit hit = closest.above(p, 100, {origin, up, 0.5, 0.3});
    EXPECT_NEAR(hit.distance, above, 1e-12);
    if (hit.triangle < 0) continue;
    EXPECT_NEAR(closest.on(hit.triangle, p).distance, above, 1e-12);
  }
}

TEST(Closest, ReportsAFreeMotionOnlyIfNothingMeetsIt) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> coordinate(-20, 20), share(0, 1);
  const auto point = [&] { return Vec3(coordinate(random), coordinate(random), coordinate(random)); };
  const Mesh mesh = torus_mesh(10, 3, 40, 20);
  const Closest closest(mesh);
  int clear = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = 0.7 * point(), up = glm::normalize(point()), origin = p - 2.0 * up;
    const Closest::Above above{origin, up, 0.1, 0.8};
    const double limit = 3 * share(random);
    const std::array<Vec3, 2> ways{0.1 * point(), 0.1 * point()};
    if (closest.may_meet(p, limit, ways, above)) continue;
    ++clear;
    for (int k = 0; k < 20; ++k) {
      double s = share(random), u = share(random);
      if (s + u > 1) s = 1 - s, u = 1 - u;
      EXPECT_LT(closest.above(p + s * ways[0] + u * ways[1], limit - 1e-12, above).triangle, 0);
    }
  }
  EXPECT_GT(clear, 500);
  EXPECT_LT(clear, 1900);
}

TEST(Closest, ReportsTheDistanceOfAWallBesideTheMotion) {
  Mesh wall;
  wall.vertices = {{-100, 1, -100}, {100, 1, -100}, {0, 1, 100}};
  wall.triangles = {{0, 1, 2}};
  const Closest closest(wall);
  const Closest::Above above{{0, 0, -1}, {0, 0, 1}, 0.5, 0.5};
  const auto meets = [&](const Vec3& way) { return closest.may_meet({0, 0, 0}, 0.99, std::span(&way, 1), above); };
  EXPECT_FALSE(meets({50, 0, 0}));
  EXPECT_FALSE(meets({0, -50, 0}));
  EXPECT_FALSE(meets({0, 0.009, 0}));
  EXPECT_TRUE(meets({0, 0.02, 0}));
}

TEST(Closest, AgreesWithEveryTriangleTried) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-20, 20);
  Mesh soup;
  for (int i = 0; i < 600; ++i) soup.vertices.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  for (int i = 0; i + 2 < 600; i += 2) soup.triangles.emplace_back(i, i + 1, i + 2);
  soup.triangles.emplace_back(5, 5, 5), soup.triangles.emplace_back(7, 7, 90);  // a point, a segment
  for (const Mesh& mesh : {soup, torus_mesh(10, 4, 30, 20), box_mesh({0, 0, 0}, {1, 2, 3})}) {
    const Closest closest(mesh);
    for (int i = 0; i < 500; ++i) {
      const Vec3 p{coordinate(random), coordinate(random), coordinate(random)};
      const double truth = slow_distance(p, mesh);
      const Closest::Hit hit = closest(p);
      EXPECT_NEAR(hit.distance, truth, 1e-12);
      EXPECT_NEAR(glm::length(p - hit.point), truth, 1e-12);
      EXPECT_NEAR(closest.distance_to(hit.triangle, p), truth, 1e-12);
      EXPECT_TRUE(closest.within(p, truth + 1e-9));
      EXPECT_FALSE(closest.within(p, truth - 1e-9));
      EXPECT_EQ(closest(p, truth - 1e-9).triangle, -1);
    }
  }
}

TEST(Closest, KeepsItsDigitsFarFromTheOrigin) {
  const Vec3 by(1e5, -2e5, 3e5);
  const Mesh sphere = sphere_mesh(10, 3);
  const std::vector<double> near = deviation(moved(sphere, {0.3, 0.2, 0.1}), sphere);
  const std::vector<double> far = deviation(moved(sphere, by + Vec3(0.3, 0.2, 0.1)), moved(sphere, by));
  for (std::size_t i = 0; i < near.size(); ++i) EXPECT_NEAR(near[i], far[i], 2e-10);
}

TEST(Closest, KnowsTheSideAtSharpEdgesAndCorners) {
  const Mesh box = box_mesh({0, 0, 0}, {1, 2, 3});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-1, 4);
  Mesh cloud;
  for (int i = 0; i < 2000; ++i)
    cloud.vertices.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  const std::vector<double> d = deviation(cloud, box, true);
  for (std::size_t i = 0; i < d.size(); ++i) {
    // The signed distance of a box, from its faces.
    const Vec3 q = glm::abs(cloud.vertices[i] - Vec3(0.5, 1, 1.5)) - Vec3(0.5, 1, 1.5);
    const double truth = glm::length(glm::max(q, Vec3(0))) + std::fmin(0, std::fmax(q.x, std::fmax(q.y, q.z)));
    EXPECT_NEAR(d[i], truth, 1e-12);
  }
}

TEST(Closest, DeviationOfAMeshFromItselfIsZero) {
  const Mesh torus = torus_mesh(10, 4, 40, 30);
  for (const double d : deviation(torus, torus)) EXPECT_EQ(d, 0);
}

TEST(Closest, DeviationIsTheSameForAnyNumberOfThreads) {
  const Mesh a = torus_mesh(10, 4, 60, 40), b = torus_mesh(10, 4.1, 50, 50);
  setenv("RIFFLER_THREADS", "1", 1);
  const std::vector<double> one = deviation(a, b, true);
  setenv("RIFFLER_THREADS", "5", 1);
  const std::vector<double> five = deviation(a, b, true);
  unsetenv("RIFFLER_THREADS");
  EXPECT_EQ(one, five);
}

TEST(Closest, RefusesAnEmptyMesh) {
  EXPECT_THROW(Closest({}), std::invalid_argument);
  EXPECT_THROW(deviation(sphere_mesh(1, 1), {}), std::invalid_argument);
  EXPECT_TRUE(deviation({}, sphere_mesh(1, 1)).empty());
}

}  // namespace
}  // namespace riffler::mesh::closest_test
