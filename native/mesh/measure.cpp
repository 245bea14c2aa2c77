#include "riffler/mesh/measure.hpp"

#include <vector>

#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

Measures measure(const Mesh& mesh) {
  if (mesh.empty()) return {};
  constexpr std::size_t kGrain = 1 << 15;
  const std::size_t n = mesh.triangles.size();
  const Vec3 origin = mesh.vertices[mesh.triangles[0].x];
  std::vector<Measures> parts((n + kGrain - 1) / kGrain);
  base::parallel_for(n, kGrain, [&](std::size_t begin, std::size_t end) {
    Measures part;
    for (std::size_t t = begin; t < end; ++t) {
      const Vec3i& v = mesh.triangles[t];
      const Vec3 &a = mesh.vertices[v.x], &b = mesh.vertices[v.y], &c = mesh.vertices[v.z];
      part.box.add(a), part.box.add(b), part.box.add(c);
      part.volume += glm::dot(a - origin, glm::cross(b - origin, c - origin));
    }
    parts[begin / kGrain] = part;
  });
  Measures out;
  for (const Measures& part : parts) out.box.add(part.box), out.volume += part.volume / 6;
  return out;
}

}  // namespace riffler::mesh
