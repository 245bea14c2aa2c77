#include "riffler/marching/pick.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "marching/pick_scenes.hpp"
#include "mesh/closest.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "support/effort.hpp"
#include "support/error_of.hpp"

namespace riffler::marching::pick_test {
namespace {

using namespace stress;
using test::Scene;
using Hit = std::optional<SurfaceHit>;

bool same(const Hit& a, const Hit& b) {
  if (!a || !b) return !a && !b;
  return a->distance == b->distance && a->point == b->point && a->normal == b->normal && a->brick == b->brick;
}

/// All triangles of a mesh, one by one and with more digits: those that a ray meets for sure, well off their rims.
class Reference {
 public:
  explicit Reference(const Mesh& mesh) : mesh_(mesh), closest_(mesh) {
    for (const Vec3i& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
      const Vec3 middle = (a + b + c) / 3.0;
      balls_.push_back(
          {middle, std::max({glm::distance(a, middle), glm::distance(b, middle), glm::distance(c, middle)})});
    }
  }

  struct Met {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 normal{0};
  };
  Met first_for_sure(const Vec3& origin, const Vec3& direction) const {
    Met out;
    for (std::size_t t = 0; t < balls_.size(); ++t) {
      const Vec3 off = balls_[t].middle - origin, beside = off - glm::dot(off, direction) * direction;
      if (glm::dot(beside, beside) > 1.0001 * balls_[t].radius * balls_[t].radius + 1e-9) continue;
      if (const double d = met(t, origin, direction); d < out.distance) out = {d, normal(t)};
    }
    return out;
  }
  double distance_of(const Vec3& p) const { return closest_(p).distance; }

 private:
  using Long3 = glm::tvec3<long double>;
  struct Ball {
    Vec3 middle;
    double radius;
  };
  Long3 corner(std::size_t t, int c) const { return Long3(mesh_.vertices[mesh_.triangles[t][c]]); }
  Vec3 normal(std::size_t t) const {
    return Vec3(glm::normalize(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0))));
  }
  /// Cramer's rule: origin + distance direction = a + u (b − a) + v (c − a).
  double met(std::size_t t, const Vec3& origin, const Vec3& direction) const {
    const Long3 a = corner(t, 0), e = corner(t, 1) - a, f = corner(t, 2) - a, d(direction), o = Long3(origin) - a;
    const long double det = glm::dot(e, glm::cross(d, f)), sure = 1e-7L;
    if (std::abs(det) < 1e-7L * glm::length(e) * glm::length(f)) return std::numeric_limits<double>::infinity();
    const long double u = glm::dot(o, glm::cross(d, f)) / det, v = glm::dot(d, glm::cross(o, e)) / det;
    const long double distance = glm::dot(f, glm::cross(o, e)) / det;
    const bool in = u > sure && v > sure && u + v < 1 - sure && distance > 1e-9L;
    return in ? static_cast<double>(distance) : std::numeric_limits<double>::infinity();
  }

  const Mesh& mesh_;
  mesh::Closest closest_;
  std::vector<Ball> balls_;
};

struct Ray {
  Vec3 origin, direction;
};

/// From anywhere to anywhere, to vertices and along edges, across and along the axes, from outside and inside of the
/// mesh's box.
Ray random_ray(Random& random, const Mesh& mesh, const Box3& box) {
  const auto somewhere = [&](double share) {
    const Vec3 s(random.uniform(-share, 1 + share), random.uniform(-share, 1 + share),
                 random.uniform(-share, 1 + share));
    return box.lower + s * box.size();
  };
  const Vec3i& t = mesh.triangles[random.below(static_cast<int>(mesh.triangles.size()))];
  const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
  const Vec3 from = random.one_in(3) ? somewhere(0) : somewhere(1.5);
  switch (random.below(7)) {
    case 0:
      return {from, somewhere(0) - from};
    case 1:
      return {from, a - from};
    case 2:
      return {from, (a + b) / 2.0 - from};
    case 3:
      return {a - random.uniform(-1, 20) * (b - a), b - a};
    case 4: {  // in the plane of the triangle
      const Vec3 way = random.uniform(-1, 1) * (b - a) + random.uniform(-1, 1) * (c - a);
      return {(a + b + c) / 3.0 - random.uniform(0, 20) * way, way};
    }
    case 5: {  // along an axis through a vertex, exactly
      Ray ray{a, random.along_rays()};
      for (int k = 0; k < 3; ++k)
        if (ray.direction[k] != 0) ray.origin[k] = from[k];
      return ray;
    }
    default:
      return {from, random.along_rays()};
  }
}

TEST(Pick, FindsTheFirstTriangleOfRaysOfAllKinds) {
  for (const Scene& scene : test::scenes()) {
    Mesher mesher(scene.volume);
    const Mesh mesh = mesher.mesh();
    const Reference reference(mesh);
    // The corners' own distance from the origin rounds.
    const Box3 box = bounds(mesh);
    const double near = 1e-9 + 1e-14 * glm::length(box.upper);
    Random random(3);
    PickStats stats;
    int hits = 0, wrong = 0;
    for (int n = 0; n < 6000 && wrong < 3; ++n) {
      Ray ray = random_ray(random, mesh, box);
      if (ray.direction == Vec3(0)) continue;
      const Reference::Met sure = reference.first_for_sure(ray.origin, glm::normalize(ray.direction));
      const Hit hit = mesher.pick(ray.origin, random.power_of_ten(-9, 9) * ray.direction, stats);
      hits += hit.has_value();
      const auto is = [&](bool right, const char* what) {
        EXPECT_TRUE(right) << scene.name << ", ray " << n << ": " << what;
        wrong += !right;
      };
      is(hit || sure.distance == std::numeric_limits<double>::infinity(), "falls through");
      if (!hit) continue;
      is(hit->distance <= sure.distance + near, "not the first");
      is(reference.distance_of(hit->point) < near, "not on the surface");
      is(glm::distance(hit->point, ray.origin + hit->distance * glm::normalize(ray.direction)) < near,
         "not on the ray");
      is(std::abs(glm::length(hit->normal) - 1) < 1e-12, "no unit normal");
      if (std::abs(hit->distance - sure.distance) < near)
        is(glm::distance(hit->normal, sure.normal) < 1e-6, "another normal");
    }
    EXPECT_GT(hits, 3000) << scene.name;
    EXPECT_LT(hits, 6000) << scene.name;
  }
}

/// The vertices of a mesh and the middles of its edges that a ray from `eye` does not merely graze.
std::vector<Vec3> not_on_the_rim(const Mesh& mesh, const Vec3& eye) {
  std::vector<int> of_vertex(mesh.vertices.size());  // 1: some triangle looks towards the eye, 2: away from it
  std::map<std::pair<int, int>, int> of_edge;
  for (const Vec3i& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
    const double side = glm::dot(glm::cross(b - a, c - a), a - eye);
    const int bits = side < -1e-9 ? 1 : side > 1e-9 ? 2 : 3;
    for (int k = 0; k < 3; ++k) of_vertex[t[k]] |= bits, of_edge[std::minmax(t[k], t[(k + 1) % 3])] |= bits;
  }
  std::vector<Vec3> out;
  for (std::size_t v = 0; v < of_vertex.size(); ++v)
    if (of_vertex[v] != 3) out.push_back(mesh.vertices[v]);
  for (const auto& [ends, bits] : of_edge)
    if (bits != 3) out.push_back((mesh.vertices[ends.first] + mesh.vertices[ends.second]) / 2.0);
  return out;
}

/// No ray from within a closed surface gets out, aimed at any edge or vertex.
TEST(Pick, LetsNoRayOutThroughEdgesAndVertices) {
  for (const Scene& scene : test::scenes()) {
    if (scene.name == "rays that contradict each other") continue;  // where is inside?
    const Box3& box = scene.volume.frame().box;
    Mesher mesher(scene.volume);
    const Mesh mesh = mesher.mesh();
    const Vec3 middle = (box.lower + box.upper) / 2.0, inside(middle.x + 1e-3, middle.y, box.lower.z + 0.7);
    PickStats stats;
    const std::vector<Vec3> points = not_on_the_rim(mesh, inside);
    EXPECT_GT(points.size(), 3 * mesh.vertices.size()) << scene.name << ", of four for each vertex";
    std::size_t out = 0, late = 0;
    for (std::size_t k = 0; k < points.size(); k += test::kSanitized ? 5 : 1) {
      const Vec3& p = points[k];
      const Hit hit = mesher.pick(inside, p - inside, stats);
      out += !hit;
      late += hit && hit->distance > glm::distance(p, inside) * (1 + 1e-12) + 1e-9;
    }
    EXPECT_EQ(out, 0U) << scene.name;
    EXPECT_EQ(late, 0U) << scene.name;
  }
}

/// Rays along the axes through vertices have exact zeros everywhere; they touch what they only graze.
TEST(Pick, TouchesVerticesAlongTheAxes) {
  for (const Scene& scene : test::scenes()) {
    Mesher mesher(scene.volume);
    const Mesh mesh = mesher.mesh();
    const Box3 box = bounds(mesh);
    PickStats stats;
    std::size_t missed = 0;
    for (std::size_t k = 0; k < mesh.vertices.size(); k += test::kSanitized ? 5 : 1)
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0}) {
          const Vec3& v = mesh.vertices[k];
          Vec3 origin = v, direction(0);
          origin[axis] = sign > 0 ? std::floor(box.lower[axis]) - 8 : std::ceil(box.upper[axis]) + 8;
          direction[axis] = sign;
          const Hit hit = mesher.pick(origin, direction, stats);
          missed += !hit || hit->distance > std::abs(v[axis] - origin[axis]) * (1 + 1e-15);
        }
    EXPECT_EQ(missed, 0U) << scene.name;
  }
}

TEST(Pick, FromAVertexHitsThatVertex) {
  for (const Scene& scene : test::scenes()) {
    Mesher mesher(scene.volume);
    Random random(4);
    PickStats stats;
    std::size_t away = 0;
    for (const Vec3& v : mesher.mesh().vertices) {
      const Hit hit = mesher.pick(v, random.direction(), stats);
      away += !hit || hit->distance != 0 || hit->point != v;
    }
    EXPECT_EQ(away, 0U) << scene.name;
  }
}

TEST(Pick, OnABlockAgreesWithGeometry) {
  Mesher mesher(Volume::block({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"}));
  PickStats stats;
  const Hit above = mesher.pick({7.3, 8.1, 30}, {0, 0, -2}, stats);
  ASSERT_TRUE(above);
  EXPECT_NEAR(above->distance, 10, 1e-6);
  EXPECT_NEAR(above->point.z, 20, 1e-6);
  EXPECT_EQ(above->normal, Vec3(0, 0, 1));
  const Hit within = mesher.pick({7.3, 8.1, 5}, {0, 0, -1}, stats);
  ASSERT_TRUE(within);
  EXPECT_NEAR(within->distance, 5, 1e-6);
  EXPECT_EQ(within->normal, Vec3(0, 0, -1));
  EXPECT_TRUE(mesher.pick({20, 8.1, 5}, {-1, 0, 0}, stats));
  EXPECT_FALSE(mesher.pick({20.1, 8.1, 5}, {1, 0, 0}, stats));
  EXPECT_FALSE(mesher.pick({7, 8, 30}, {0, 0, 1}, stats)) << "nothing lies behind";
  EXPECT_TRUE(mesher.pick({10, 10, 1e9}, {0, 0, -1e-300}, stats)) << "from afar, in a very short direction";
  EXPECT_TRUE(mesher.pick({10, 10, 30}, {0, 0, -1e300}, stats));
  EXPECT_TRUE(mesher.pick({10, 10, 30}, {1e-300, -5e-324, -1}, stats));
}

TEST(Pick, RefusesInvalidRays) {
  Mesher mesher(Volume::block({{{0, 0, 0}, {4, 4, 4}}, 0.5, "xyz"}));
  PickStats stats;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(test::error_of([&] { mesher.pick({0, nan, 0}, {0, 0, 1}, stats); }), "origin: not finite");
  EXPECT_EQ(test::error_of([&] { mesher.pick({0, 0, 0}, {0, 0, 0}, stats); }), "direction: not finite or zero");
  EXPECT_EQ(test::error_of([&] { mesher.pick({0, 0, 0}, {0, 0, INFINITY}, stats); }), "direction: not finite or zero");
}

TEST(Pick, OnAnEmptyMeshFindsNothing) {
  const Volume nothing({{{0, 0, 0}, {20, 20, 20}}, 0.5, "xyz"});
  Mesher mesher(nothing);
  PickStats stats;
  EXPECT_FALSE(mesher.pick({10, 10, 30}, {0, 0, -1}, stats));
  EXPECT_FALSE(mesher.freeze(stats).pick({10, 10, 30}, {0, 0, -1}, stats));
  EXPECT_EQ(stats.bricks_visited, 0U);
}

TEST(Pick, FollowsTheMesherToTheBit) {
  Volume volume = test::nicked_bar({0, 0, 0}, {40, 4, 3}, "xyz");
  Mesher mesher(volume);
  Random random(8);
  PickStats stats, other;
  for (int step = 0; step < test::cases(12, 3); ++step) {
    test::nick(volume, random);
    mesher.update(volume);
    Mesher anew(volume);
    const Mesh mesh = anew.mesh();
    const Box3 box = bounds(mesh);
    for (int n = 0; n < 300; ++n) {
      const Ray ray = random_ray(random, mesh, box);
      ASSERT_TRUE(same(mesher.pick(ray.origin, ray.direction, stats), anew.pick(ray.origin, ray.direction, other)));
    }
  }
  EXPECT_LT(stats.bricks_prepared, other.bricks_prepared / 2);
}

TEST(Pick, CostsOnlyTheBricksAlongTheRay) {
  Volume volume = test::nicked_bar({0, 0, 0}, {80, 4, 3}, "xyz");  // 11 bricks
  Mesher mesher(volume);
  PickStats stats;
  ASSERT_TRUE(mesher.pick({12, 2, 10}, {0, 0, -1}, stats));
  EXPECT_EQ(stats.bricks_prepared, 1U);
  EXPECT_EQ(stats.bricks_visited, 1U);
  EXPECT_LT(stats.triangles_tested, mesher.triangles() / 50);
  ASSERT_TRUE(mesher.pick({12.5, 2, 10}, {0, 0, -1}, stats));
  EXPECT_EQ(stats.bricks_prepared, 1U) << "what did not change is ready";
  stats = {};
  mesher.pick({12, 2, 10}, {1, 0, 0}, stats);
  EXPECT_EQ(stats.bricks_visited, 0U) << "above all";
  mesher.freeze(stats);
  EXPECT_EQ(stats.bricks_prepared, mesher.patches().size() - 1);
  stats = {};
  Random random(1);
  test::nick(volume, random);
  const std::size_t changed = mesher.update(volume).size();
  EXPECT_GT(changed, 0U);
  mesher.freeze(stats);
  EXPECT_LE(stats.bricks_prepared, changed);
  stats = {};
  mesher.freeze(stats);
  EXPECT_EQ(stats.bricks_prepared, 0U);
}

/// Some rays and what they hit.
std::vector<Hit> answers(const FrozenSurface& surface, const std::vector<Ray>& rays) {
  PickStats stats;
  std::vector<Hit> out;
  for (const Ray& ray : rays) out.push_back(surface.pick(ray.origin, ray.direction, stats));
  return out;
}

TEST(FrozenSurface, KeepsTheStateOfTheMesher) {
  Volume volume = test::nicked_bar({0, 0, 0}, {40, 4, 3}, "xyz");
  Random random(21);
  std::vector<FrozenSurface> frozen;
  std::vector<std::vector<Hit>> live;
  std::vector<Ray> rays;
  {
    Mesher mesher(volume);
    const Mesh mesh = mesher.mesh();
    const Box3 box = bounds(mesh);
    for (int n = 0; n < 500; ++n) rays.push_back(random_ray(random, mesh, box));
    PickStats stats;
    for (int step = 0; step < 10; ++step) {
      frozen.push_back(mesher.freeze(stats));
      EXPECT_EQ(frozen.back().triangles(), mesher.triangles());
      live.emplace_back();
      for (const Ray& ray : rays) live.back().push_back(mesher.pick(ray.origin, ray.direction, stats));
      for (int n = 0; n < 6; ++n) test::nick(volume, random);
      mesher.update(volume);
    }
    mesher.update(Volume(volume.frame()));  // nothing is left
  }
  std::size_t differ = 0;
  for (std::size_t step = 0; step < frozen.size(); ++step) {
    const std::vector<Hit> now = answers(frozen[step], rays);
    for (std::size_t n = 0; n < rays.size(); ++n) {
      EXPECT_TRUE(same(now[n], live[step][n])) << "step " << step << ", ray " << n;
      differ += !same(now[n], live[0][n]);
    }
  }
  EXPECT_GT(differ, 100U) << "the strokes changed what these rays meet";
}

}  // namespace
}  // namespace riffler::marching::pick_test
