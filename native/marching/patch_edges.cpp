#include "marching/patch_edges.hpp"

#include <algorithm>
#include <cstdint>

namespace riffler::marching {

PatchEdges edges_of(const MeshPatch& patch) {
  struct Link {
    std::int32_t upper, next;
  };
  PatchEdges out;
  out.of_corner.resize(patch.triangles.size());
  // Euler: without handles there are no more edges than this.
  const std::size_t about = patch.vertices.size() + patch.triangles.size();
  out.vertices.reserve(about);
  // For each vertex, a list of its edges to vertices with higher numbers, usually three.
  std::vector<std::int32_t> first(patch.vertices.size(), -1);
  std::vector<Link> links;
  links.reserve(about);
  const auto edge = [&](std::int32_t a, std::int32_t b) {
    const auto [lower, upper] = std::minmax(a, b);
    for (std::int32_t e = first[lower]; e >= 0; e = links[e].next)
      if (links[e].upper == upper) return e;
    const auto made = static_cast<std::int32_t>(links.size());
    links.push_back({upper, first[lower]});
    out.vertices.push_back({a, b});
    return first[lower] = made;
  };
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    const Vec3i& c = patch.triangles[t];
    out.of_corner[t] = {edge(c.x, c.y), edge(c.y, c.z), edge(c.z, c.x)};
  }
  return out;
}

}  // namespace riffler::marching
