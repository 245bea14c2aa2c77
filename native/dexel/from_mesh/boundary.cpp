#include "dexel/from_mesh/boundary.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "base/mix.hpp"
#include "base/sort_unique.hpp"
#include "mesh/near_points.hpp"
#include "mesh/weld.hpp"

namespace riffler::dexel {

namespace {

struct HalfEdge {
  int from, to;
};

/// For each vertex a, the sum of ± hash(b) over half-edges between a and higher vertices b. It is zero if all pairs
/// cancel (and by chance with probability 2^−64).
class Pairing {
 public:
  explicit Pairing(std::size_t vertices) : sums_(vertices, 0) {}

  void add(int from, int to) {
    if (from < to) sums_[from] += base::mix_bits(static_cast<std::uint64_t>(to) + 1);
    if (to < from) sums_[to] -= base::mix_bits(static_cast<std::uint64_t>(from) + 1);
  }
  bool paired(int from, int to) const { return sums_[std::min(from, to)] == 0; }
  bool all_paired() const {
    return std::all_of(sums_.begin(), sums_.end(), [](std::uint64_t s) { return s == 0; });
  }

 private:
  std::vector<std::uint64_t> sums_;
};

template <class Visit>
void for_each_half_edge(const Mesh& mesh, const Visit& visit) {
  for (const Vec3i& t : mesh.triangles) visit(t.x, t.y), visit(t.y, t.z), visit(t.z, t.x);
}

/// Half-edges that may have no partner, between vertices with different coordinates, which get new numbers.
struct Seams {
  std::vector<HalfEdge> edges;
  std::vector<int> first;                   // for each number, the first vertex of the mesh
  std::vector<std::pair<int, int>> others;  // vertices and their numbers
};

Seams weld_seams(const Mesh& mesh, std::vector<HalfEdge> edges) {
  Seams out;
  std::vector<int> number(mesh.vertices.size(), -1), ends;
  for (const HalfEdge& e : edges) number[e.from] = number[e.to] = 0;
  for (std::size_t k = 0; k < number.size(); ++k)
    if (number[k] == 0) ends.push_back(static_cast<int>(k));
  mesh::Welder<Vec3> welder(ends.size());
  for (const int k : ends) {
    number[k] = welder.add(mesh.vertices[k]);
    if (number[k] == static_cast<int>(out.first.size()))
      out.first.push_back(k);
    else
      out.others.emplace_back(k, number[k]);
  }
  out.edges = std::move(edges);
  for (HalfEdge& e : out.edges) e = {number[e.from], number[e.to]};
  return out;
}

/// The unpaired half-edges, sorted by their start, each with its multiplicity.
std::vector<HalfEdge> leftover(const std::vector<HalfEdge>& all, std::size_t vertices) {
  Pairing pairing(vertices);
  for (const HalfEdge& e : all) pairing.add(e.from, e.to);
  struct Directed {
    int low, high, sign;
  };
  std::vector<Directed> candidates;
  for (const HalfEdge& e : all)
    if (e.from != e.to && !pairing.paired(e.from, e.to))
      candidates.push_back({std::min(e.from, e.to), std::max(e.from, e.to), e.from < e.to ? 1 : -1});
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

/// Follows `edges` until all are used. As many edges enter a vertex as leave it, so a walk can only end where it began.
/// When a walk returns to a vertex on its path, that part is cut off as a loop of its own.
std::vector<std::vector<int>> walks(const std::vector<HalfEdge>& edges, std::size_t vertices) {
  std::vector<std::size_t> next(vertices + 1, 0);  // the first unused edge of each vertex
  for (const HalfEdge& e : edges) ++next[e.from + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<int> place(vertices, -1);  // position on the current path, −1 if not on it
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

Boundary find_boundary(const Mesh& mesh) {
  Pairing pairing(mesh.vertices.size());
  for_each_half_edge(mesh, [&](int from, int to) { pairing.add(from, to); });
  if (pairing.all_paired()) return {};
  // Half-edges paired by index are also paired by coordinates.
  std::vector<HalfEdge> edges;
  for_each_half_edge(mesh, [&](int from, int to) {
    if (!pairing.paired(from, to)) edges.push_back({from, to});
  });
  const Seams seams = weld_seams(mesh, std::move(edges));
  Boundary out;
  out.loops = walks(leftover(seams.edges, seams.first.size()), seams.first.size());
  if (out.loops.empty()) return out;
  for (std::vector<int>& loop : out.loops)
    for (int& k : loop) k = seams.first[k];
  for (const auto& [k, number] : seams.others) out.twins.emplace_back(k, seams.first[number]);
  return out;
}

std::optional<Mesh> join_cracks(const Mesh& mesh, const Boundary& boundary, double tolerance) {
  std::vector<int> rim;
  for (const std::vector<int>& loop : boundary.loops) rim.insert(rim.end(), loop.begin(), loop.end());
  base::sort_unique(rim);
  mesh::NearPoints near(tolerance, rim.size());
  std::vector<std::pair<int, Vec3>> moved;
  for (const int k : rim)
    if (const Vec3 p = near[near.find_or_add(mesh.vertices[k])]; p != mesh.vertices[k]) moved.emplace_back(k, p);
  if (moved.empty()) return {};
  Mesh joined = mesh;
  for (const auto& [k, p] : moved) joined.vertices[k] = p;
  for (const auto& [k, twin] : boundary.twins) joined.vertices[k] = joined.vertices[twin];
  return joined;
}

}  // namespace riffler::dexel
