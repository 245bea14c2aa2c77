#include "marching/facets.hpp"

#include <algorithm>

namespace riffler::marching {

namespace {

/// Whether the ray meets a triangle of sheared corners, and where. A ray through an edge or corner meets all triangles
/// that share it, from either side. `u`, `v`, `w`: areas opposite a, b, c.
bool meets(const Vec3& a, const Vec3& b, const Vec3& c, double u, double v, double w, double& distance) {
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const double area = u + v + w;
  if (area == 0) return false;  // edge-on: its neighbours have the edges
  distance = (u * a.z + v * b.z + w * c.z) / area;
  return distance >= 0;
}

}  // namespace

Facets::Facets(const Surface& surface, const ActiveBrick& brick) {
  const Mesh& mesh = surface.mesh;
  const std::size_t count = brick.edges();
  quads_.reserve(count), runs_.reserve((count + kRun - 1) / kRun);
  for (std::size_t first = 0; first < count; first += kRun) {
    Vec3f lower(std::numeric_limits<float>::infinity()), upper = -lower;
    const auto place = [&](std::int32_t v) {
      const Vec3f p(mesh.vertices[v]);  // a float represents every place that a vertex may take
      lower = glm::min(lower, p), upper = glm::max(upper, p);
      return p;
    };
    for (std::size_t n = first; n < std::min(first + kRun, count); ++n) {
      const std::size_t quad = brick.first_edge + n;
      const Vec3i* const t = &mesh.triangles[2 * quad];
      const int turned = surface.diagonal(quad);  // the corners begin at the diagonal
      const Vec3i &a = t[turned], &b = t[1 - turned];
      quads_.push_back({place(a.x), place(a.y), place(a.z), place(turned ? b.x : b.z)});
    }
    runs_.push_back({lower, upper});
  }
  groups_.resize((runs_.size() + kGroup - 1) / kGroup);
  for (std::size_t r = 0; r < runs_.size(); ++r) groups_[r / kGroup].add(runs_[r]);
}

std::uint64_t Facets::look(const Sight& sight, std::size_t brick, Nearest& best) const {
  std::uint64_t tested = 0;
  const auto may_have = [&](const Box& box) {
    const Sight::Range range = sight.through(box.lower, box.upper);
    return !range.empty() && range.enter <= best.distance;
  };
  const auto test = [&](std::size_t n) {
    Vec3 p[4];
    for (int k = 0; k < 4; ++k) p[k] = sight.sheared(Vec3(quads_[n][k]));
    tested += 2;
    const auto aside = [&](int a) {
      return (p[0][a] > 0 && p[1][a] > 0 && p[2][a] > 0 && p[3][a] > 0) ||
             (p[0][a] < 0 && p[1][a] < 0 && p[2][a] < 0 && p[3][a] < 0);
    };
    if (aside(0) || aside(1)) return;  // most quads
    const double across = twice_area(p[0], p[2]);
    for (int half = 0; half < 2; ++half) {
      const Vec3 &b = p[half + 1], &c = p[half + 2];
      const double v = half ? twice_area(c, p[0]) : -across, w = half ? across : twice_area(p[0], b);
      double distance;
      if (!meets(p[0], b, c, twice_area(b, c), v, w, distance) || !best.after(distance, brick, 2 * n + half)) continue;
      const Vec3 at(quads_[n][0]);
      best = {distance, brick, 2 * n + half,
              glm::cross(Vec3(quads_[n][half + 1]) - at, Vec3(quads_[n][half + 2]) - at)};
    }
  };
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (!may_have(groups_[g])) continue;
    for (std::size_t r = g * kGroup; r < std::min((g + 1) * kGroup, runs_.size()); ++r) {
      if (!may_have(runs_[r])) continue;
      for (std::size_t n = r * kRun; n < std::min((r + 1) * kRun, quads_.size()); ++n) test(n);
    }
  }
  return tested;
}

std::size_t Facets::nbytes() const {
  return quads_.size() * sizeof(Corners) + (runs_.size() + groups_.size()) * sizeof(Box);
}

}  // namespace riffler::marching
