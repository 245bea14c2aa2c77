#include "riffler/dexel/from_mesh/mesh_report.hpp"

#include <atomic>

#include "mesh/adjacency.hpp"
#include "mesh/near_points.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::dexel {

namespace {

using Count = std::atomic<std::size_t>;

bool is_degenerate(const Mesh& mesh, const Vec3i& t) {
  const Vec3& a = mesh.vertices[t.x];
  return mesh::repeats_a_vertex(t) || glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a) == Vec3(0);
}

void count_edges(const Mesh& mesh, MeshReport& report) {
  Count open{0}, crowded{0}, same_way{0}, duplicates{0};
  mesh::EdgeTable(mesh).for_each_edge([&](int, std::span<const mesh::EdgeTable::Use> uses) {
    if (uses.size() == 1) ++open;
    if (uses.size() >= 3) ++crowded;
    if (uses.size() == 2 && uses[0].reversed() == uses[1].reversed()) ++same_way;
    if (const std::size_t n = duplicates_at(mesh, uses)) duplicates += n;
  });
  report.open_edges = open, report.nonmanifold_edges = crowded;
  report.inconsistent_edges = same_way, report.duplicates = duplicates;
}

}  // namespace

void count_defects(const Mesh& mesh, MeshReport& report) {
  report.triangles = mesh.triangles.size();
  Count degenerate{0};
  base::parallel_for(mesh.triangles.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) count += is_degenerate(mesh, mesh.triangles[t]);
    degenerate += count;
  });
  report.degenerate = degenerate;
  count_edges(mesh, report);
  // If every edge has its neighbours by index, equal coordinates add nothing.
  if (report.open_edges > 0) count_edges(welded(mesh), report);
}

std::size_t count_shells(const Mesh& mesh, const std::vector<std::uint8_t>& marks) {
  const Mesh joined = welded(mesh);
  // Link the half-edges around each edge, from one triangle to the next.
  std::vector<int> next(3 * joined.triangles.size(), -1);
  mesh::EdgeTable(joined).for_each_edge([&](int, std::span<const mesh::EdgeTable::Use> uses) {
    for (std::size_t k = 0; k < uses.size(); ++k) next[uses[k].half()] = uses[(k + 1) % uses.size()].half();
  });
  std::vector<bool> seen(marks.size(), false);
  std::vector<int> pending;
  std::size_t shells = 0;
  for (std::size_t t = 0; t < marks.size(); ++t) {
    if (!marks[t] || seen[t]) continue;
    ++shells;
    seen[t] = true;
    pending.push_back(static_cast<int>(t));
    while (!pending.empty()) {
      const int at = pending.back();
      pending.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int across = next[3 * at + k];
        if (across < 0 || seen[mesh::triangle_of(across)]) continue;
        seen[mesh::triangle_of(across)] = true;
        pending.push_back(mesh::triangle_of(across));
      }
    }
  }
  return shells;
}

}  // namespace riffler::dexel
