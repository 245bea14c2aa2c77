#include "collide/surface.hpp"

#include <algorithm>

namespace riffler::collide {

std::vector<Corners> Surface::corners_of(const Mesh& mesh) {
  std::vector<Corners> out(mesh.triangles.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    const Vec3i& v = mesh.triangles[t];
    out[t] = {mesh.vertices[v.x], mesh.vertices[v.y], mesh.vertices[v.z]};
  }
  return out;
}

Surface::Surface(const std::vector<Corners>& corners)
    : tree_({corners.size(),
             [&](std::size_t t) {
               Box3 box;
               box.add(corners[t].a), box.add(corners[t].b), box.add(corners[t].c);
               return box;
             },
             [&](std::size_t t) { return round_triangle(corners[t].a, corners[t].b, corners[t].c); },
             [&](std::size_t t, const Vec3& p) {
               const Corners& c = corners[t];
               return std::max({glm::length(c.a - p), glm::length(c.b - p), glm::length(c.c - p)});
             }}) {
  corners_.reserve(corners.size() + base::kLanes);
  for (const std::uint32_t t : tree_.order()) corners_.push_back(corners[t]);
  corners_.resize(corners.size() + base::kLanes, {Vec3(0), Vec3(0), Vec3(0)});
}

}  // namespace riffler::collide
