#include "riffler/mesh/audit.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <vector>

#include "mesh/adjacency.hpp"
#include "mesh/near_points.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

namespace {

using Count = std::atomic<std::size_t>;
constexpr std::size_t kAuditGrain = 1 << 14;

/// Sums over chunks of [0, n), in parallel. Counts are integers, so their order does not matter.
template <class Test>
std::size_t count_if(std::size_t n, const Test& test) {
  Count total{0};
  base::parallel_for(n, kAuditGrain, [&](std::size_t begin, std::size_t end) {
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) count += test(static_cast<int>(i)) ? 1 : 0;
    total += count;
  });
  return total;
}

Vec3 cross_of(const Mesh& mesh, const Vec3i& t) {
  const Vec3& a = mesh.vertices[t.x];
  return glm::cross(mesh.vertices[t.y] - a, mesh.vertices[t.z] - a);
}

bool is_fold(const Mesh& mesh, int half, int twin) {
  const Vec3 a = cross_of(mesh, mesh.triangles[triangle_of(half)]);
  const Vec3 b = cross_of(mesh, mesh.triangles[triangle_of(twin)]);
  const double dot = glm::dot(a, b), lengths = glm::length(a) * glm::length(b);
  return lengths > 0 && dot < -0.99999 * lengths;
}

/// The edge at vertex v on the other side of the triangle of `half`; v is one of the ends of `half`.
int other_edge_at(const Mesh& mesh, int half, int v) {
  return start_of(mesh, half) == v ? previous_half(half) : next_half(half);
}

class Fans {
 public:
  Fans(const Mesh& mesh, const Adjacency& adjacency)
      : mesh_(mesh), adjacency_(adjacency), first_(mesh.vertices.size(), -1), valence_(mesh.vertices.size(), 0) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (repeats_a_vertex(mesh.triangles[t])) continue;
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.triangles[t][k];
        first_[v] = static_cast<int>(3 * t) + k;
        ++valence_[v];
      }
    }
  }

  bool is_single(int v) const {
    if (first_[v] < 0) return true;
    const int out = first_[v], in = previous_half(out);
    bool closed = false, crowded = false;
    const int n = walk(v, out, closed, crowded);
    const int m = closed ? 0 : walk(v, in, closed, crowded);
    return !crowded && n + m + 1 == valence_[v];
  }

 private:
  /// Number of triangles visited after the first, crossing `edge` and continuing around v.
  int walk(int v, int edge, bool& closed, bool& crowded) const {
    const int start = triangle_of(edge);
    for (int n = 0;; ++n) {
      crowded |= adjacency_.is_crowded(edge);
      const int across = adjacency_.neighbour(edge);
      if (across < 0) return n;
      if (triangle_of(across) == start) {
        closed = true;
        return n;
      }
      edge = other_edge_at(mesh_, across, v);
    }
  }

  const Mesh& mesh_;
  const Adjacency& adjacency_;
  std::vector<int> first_, valence_;  // a half-edge that starts at the vertex; number of triangles at it
};

/// Disjoint sets with path halving (Tarjan & van Leeuwen 1984). The root is the smallest index.
class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

std::size_t count_components(const Mesh& mesh, const Adjacency& adjacency,
                             const std::vector<std::pair<int, int>>& crowded) {
  Sets sets(mesh.triangles.size());
  const int halves = static_cast<int>(3 * mesh.triangles.size());
  for (int half = 0; half < halves; ++half)
    if (const int across = adjacency.neighbour(half); across > half) sets.join(half / 3, across / 3);
  for (const auto& [a, b] : crowded) sets.join(a / 3, b / 3);
  std::size_t count = 0;
  for (int t = 0; t < halves / 3; ++t) count += sets.root(t) == t && !repeats_a_vertex(mesh.triangles[t]) ? 1 : 0;
  return count;
}

}  // namespace

Audit audit(const Mesh& mesh, const Progress& progress) {
  validate(mesh);
  Audit result;
  result.volume = volume(mesh);
  const EdgeTable edges(mesh);
  base::report(progress, 0.3);
  const Adjacency adjacency(mesh, edges);
  base::report(progress, 0.4);

  Count bad{0}, twice{0};
  std::mutex mutex;
  std::vector<std::pair<int, int>> crowded;  // pairs of half-edges at edges with three or more triangles
  edges.for_each_edge([&](int, std::span<const EdgeTable::Use> uses) {
    if (uses.size() < 2) return;
    if (const std::size_t n = duplicates_at(mesh, uses)) twice += n;
    if (uses.size() == 2 && !adjacency.is_same_way(uses[0].half())) return;
    ++bad;
    if (uses.size() == 2) return;
    const std::lock_guard lock(mutex);
    for (const EdgeTable::Use& use : uses.subspan(1)) crowded.emplace_back(uses[0].half(), use.half());
  });
  result.nonmanifold_edges = bad;
  result.duplicates = twice;
  base::report(progress, 0.5);

  const std::size_t halves = 3 * mesh.triangles.size();
  result.open_edges = count_if(halves, [&](int half) { return adjacency.is_open(half); });
  // Rounding may have separated equal vertices.
  if (result.open_edges > 0)
    if (const std::optional<Mesh> joined = join_near(mesh)) return audit(*joined, base::part(progress, 0.5, 1));
  result.folds = count_if(halves, [&](int half) {
    const int twin = adjacency.twin(half);
    return twin > half && is_fold(mesh, half, twin);
  });
  base::report(progress, 0.7);
  result.degenerate = count_if(mesh.triangles.size(), [&](int t) {
    const Vec3i& v = mesh.triangles[t];
    return repeats_a_vertex(v) || cross_of(mesh, v) == Vec3(0);
  });
  const Fans fans(mesh, adjacency);
  result.nonmanifold_vertices = count_if(mesh.vertices.size(), [&](int v) { return !fans.is_single(v); });
  base::report(progress, 0.9);
  result.components = count_components(mesh, adjacency, crowded);
  return result;
}

}  // namespace riffler::mesh
