#include "dexel/boundary.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

namespace riffler {

namespace {

std::uint64_t mix(std::uint64_t x) {  // the finaliser of MurmurHash3
  x ^= x >> 33, x *= 0xff51afd7ed558ccdULL;
  x ^= x >> 33, x *= 0xc4ceb9fe1a85ec53ULL;
  return x ^ x >> 33;
}

/// For each vertex a, the sum over its half-edges to higher vertices b of ± hash(b): zero where all pairs cancel (and
/// by chance with probability 2^−64).
std::vector<std::uint64_t> unpaired(const Mesh& mesh, const std::vector<int>& same) {
  std::vector<std::uint64_t> sums(mesh.vertices.size(), 0);
  const auto add = [&](int a, int b) {
    if (a < b) sums[a] += mix(static_cast<std::uint64_t>(b) + 1);
    if (b < a) sums[b] -= mix(static_cast<std::uint64_t>(a) + 1);
  };
  for (const Vec3i& t : mesh.triangles) {
    const int a = same.empty() ? t.x : same[t.x], b = same.empty() ? t.y : same[t.y],
              c = same.empty() ? t.z : same[t.z];
    add(a, b), add(b, c), add(c, a);
  }
  return sums;
}

bool all_zero(const std::vector<std::uint64_t>& sums) {
  return std::all_of(sums.begin(), sums.end(), [](std::uint64_t s) { return s == 0; });
}

/// For each vertex the first one with equal coordinates.
std::vector<int> weld(const Vertices& vertices) {
  const std::size_t slots = std::bit_ceil(vertices.size() * 2 + 1);
  std::vector<int> table(slots, -1), same(vertices.size());
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const Vec3 p = vertices[k] + 0.0;  // −0 becomes 0
    std::uint64_t h = mix(std::bit_cast<std::uint64_t>(p.x));
    h = mix(h + std::bit_cast<std::uint64_t>(p.y)), h = mix(h + std::bit_cast<std::uint64_t>(p.z));
    std::size_t slot = h & (slots - 1);
    while (table[slot] >= 0 && vertices[table[slot]] != vertices[k]) slot = (slot + 1) & (slots - 1);
    if (table[slot] < 0) table[slot] = static_cast<int>(k);
    same[k] = table[slot];
  }
  return same;
}

struct HalfEdge {
  int from, to;
};

/// The half-edges that are left over, sorted by their start, each with its multiplicity.
std::vector<HalfEdge> leftover(const Mesh& mesh, const std::vector<int>& same, const std::vector<std::uint64_t>& sums) {
  struct Directed {
    int low, high, sign;
  };
  std::vector<Directed> candidates;
  const auto add = [&](int a, int b) {
    if (a < b && sums[a] != 0) candidates.push_back({a, b, 1});
    if (b < a && sums[b] != 0) candidates.push_back({b, a, -1});
  };
  for (const Vec3i& t : mesh.triangles) {
    const int a = same[t.x], b = same[t.y], c = same[t.z];
    add(a, b), add(b, c), add(c, a);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Directed& a, const Directed& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  std::vector<HalfEdge> edges;
  for (std::size_t k = 0; k < candidates.size();) {
    const Directed& e = candidates[k];
    int net = 0;
    for (; k < candidates.size() && candidates[k].low == e.low && candidates[k].high == e.high; ++k)
      net += candidates[k].sign;
    for (; net > 0; --net) edges.push_back({e.low, e.high});
    for (; net < 0; ++net) edges.push_back({e.high, e.low});
  }
  std::stable_sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.from < b.from; });
  return edges;
}

/// Walks along `edges` until all are used. As many edges enter a vertex as leave it, so a walk only ever ends where it
/// began; one that comes back to a vertex on its way is cut off there as a loop of its own.
std::vector<std::vector<int>> walks(const std::vector<HalfEdge>& edges, std::size_t vertices) {
  std::vector<std::size_t> next(vertices + 1, 0);  // the first unused edge of each vertex
  for (const HalfEdge& e : edges) ++next[e.from + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<int> place(vertices, -1);  // on the current path
  std::vector<std::vector<int>> loops;
  std::vector<bool> used(edges.size(), false);
  std::vector<int> path;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    if (used[k]) continue;
    path.assign(1, edges[k].from);
    place[path[0]] = 0;
    while (true) {
      const int at = path.back();
      const std::size_t e = next[at];
      if (e >= edges.size() || edges[e].from != at) break;  // only the start runs out of edges
      ++next[at], used[e] = true;
      const int to = edges[e].to;
      if (place[to] < 0) {
        place[to] = static_cast<int>(path.size());
        path.push_back(to);
        continue;
      }
      const auto begin = path.begin() + place[to];
      loops.emplace_back(begin, path.end());
      for (auto v = begin + 1; v != path.end(); ++v) place[*v] = -1;
      path.erase(begin + 1, path.end());
    }
    for (const int v : path) place[v] = -1;
  }
  return loops;
}

}  // namespace

std::vector<std::vector<int>> boundary_loops(const Mesh& mesh) {
  if (all_zero(unpaired(mesh, {}))) return {};
  const std::vector<int> same = weld(mesh.vertices);
  const std::vector<std::uint64_t> sums = unpaired(mesh, same);
  if (all_zero(sums)) return {};
  return walks(leftover(mesh, same, sums), mesh.vertices.size());
}

namespace {

/// Points in buckets of side `size`, each looked for among its neighbours.
class Buckets {
 public:
  Buckets(double size, std::size_t points) : size_(size), heads_(std::bit_ceil(2 * points + 1), -1) {
    points_.reserve(points);
  }

  /// The first point within `size` of p; p itself, added, where there is none.
  Vec3 find_or_add(const Vec3& p) {
    const Vec3 cell = glm::floor(p / size_);
    for (int k = 0; k < 27; ++k) {
      const Vec3 near = cell + Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      for (int at = heads_[slot(near)]; at >= 0; at = points_[at].next)
        if (points_[at].cell == near && glm::length(points_[at].p - p) <= size_) return points_[at].p;
    }
    int& head = heads_[slot(cell)];
    points_.push_back({p, cell, head});
    head = static_cast<int>(points_.size()) - 1;
    return p;
  }

 private:
  struct Point {
    Vec3 p, cell;
    int next;
  };
  std::size_t slot(const Vec3& cell) const {
    const Vec3 c = cell + 0.0;  // −0 becomes 0
    std::uint64_t h = mix(std::bit_cast<std::uint64_t>(c.x));
    h = mix(h + std::bit_cast<std::uint64_t>(c.y)), h = mix(h + std::bit_cast<std::uint64_t>(c.z));
    return h & (heads_.size() - 1);
  }

  double size_;
  std::vector<int> heads_;
  std::vector<Point> points_;
};

}  // namespace

Mesh join_cracks(const Mesh& mesh, const std::vector<std::vector<int>>& loops, double tolerance) {
  Mesh joined = mesh;
  const std::vector<int> same = weld(mesh.vertices);
  std::vector<bool> on_boundary(mesh.vertices.size(), false);
  for (const std::vector<int>& loop : loops)
    for (const int k : loop) on_boundary[k] = true;
  Buckets buckets(tolerance, mesh.vertices.size());
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k)
    if (on_boundary[k]) joined.vertices[k] = buckets.find_or_add(mesh.vertices[k]);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) joined.vertices[k] = joined.vertices[same[k]];
  return joined;
}

}  // namespace riffler
