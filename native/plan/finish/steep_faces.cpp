#include "plan/finish/steep_faces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/median_tree.hpp"

namespace riffler::plan {

namespace {

Vec2 nearest_on_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double square = glm::dot(way, way);
  return a + way * (square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0.0);
}

}  // namespace

SteepFaces::SteepFaces(const Mesh& mesh) {
  std::vector<Triangle> all;
  std::vector<int> numbers;
  std::vector<Vec3> centres;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const Vec3i& t = mesh.triangles[k];
    const Triangle tri{mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]};
    const Vec3 n = glm::cross(tri.b - tri.a, tri.c - tri.a);
    if (!(geom::hypot(n.x, n.y) > 0) || base::atan2(geom::hypot(n.x, n.y), std::abs(n.z)) < kSteep) continue;
    all.push_back(tri), numbers.push_back(static_cast<int>(k)), centres.push_back((tri.a + tri.b + tri.c) / 3.0);
  }
  const std::size_t n = all.size();
  while ((n >> levels_) > 4) ++levels_;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  geom::sort_by_medians(order, levels_, centres);
  for (const std::size_t t : order) triangles_.push_back(all[t]), numbers_.push_back(numbers[t]);
  boxes_ = geom::boxes_of_tree(levels_, [&](std::size_t leaf) {
    Box3 box;
    for (std::size_t t = geom::first_item(n, levels_, leaf); t < geom::first_item(n, levels_, leaf + 1); ++t)
      box.add(triangles_[t].a), box.add(triangles_[t].b), box.add(triangles_[t].c);
    return box;
  });
}

SteepFaces::Found SteepFaces::nearest(const Vec3& p, double reach, double slack, double band) const {
  Found out;
  if (triangles_.empty()) return out;
  double least = reach;
  const auto far = [&](const Box3& box) {
    if (p.z < box.lower.z - slack || p.z > box.upper.z + slack) return true;
    const double x = std::max({box.lower.x - p.x, p.x - box.upper.x, 0.0}),
                 y = std::max({box.lower.y - p.y, p.y - box.upper.y, 0.0});
    return geom::hypot(x, y) > least;
  };
  const auto look = [&](std::size_t k) {
    const std::array<Vec3, 3> v{triangles_[k].a, triangles_[k].b, triangles_[k].c};
    const auto [low, high] = std::minmax({v[0].z, v[1].z, v[2].z});
    if (p.z < low - slack || p.z > high + slack) return;
    const double z = std::clamp(p.z, low, high);
    std::array<Vec2, 6> section;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 &a = v[i], &b = v[(i + 1) % 3];
      if (std::min(a.z, b.z) > z + band || std::max(a.z, b.z) < z - band) continue;
      for (const double end : {z - band, z + band})
        section[count++] = Vec2(glm::mix(a, b, a.z == b.z ? end > z : std::clamp((end - a.z) / (b.z - a.z), 0.0, 1.0)));
    }
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t j = i; j < count; ++j) {
        const Vec2 q = nearest_on_line(Vec2(p), section[i], section[j]);
        const double d = geom::hypot(q.x - p.x, q.y - p.y);
        if (d < least || (d == least && out.triangle < 0)) least = d, out = {numbers_[k], Vec3(q, z)};
      }
  };
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, 0}};  // level, place
  while (!open.empty()) {
    const auto [level, place] = open.back();
    open.pop_back();
    if (far(boxes_[(std::size_t{1} << level) - 1 + place])) continue;
    if (level == levels_) {
      for (std::size_t t = geom::first_item(triangles_.size(), level, place);
           t < geom::first_item(triangles_.size(), level, place + 1); ++t)
        look(t);
    } else {
      open.emplace_back(level + 1, 2 * place), open.emplace_back(level + 1, 2 * place + 1);
    }
  }
  return out;
}

}  // namespace riffler::plan
