#include "mesh/adjacency.hpp"

#include <algorithm>
#include <stdexcept>

#include "riffler/base/parallel.hpp"

namespace riffler::mesh {

EdgeTable::EdgeTable(const Mesh& mesh) : begin_(mesh.vertices.size() + 2, 0) {
  if (mesh.triangles.size() > 0x7fffffff / 3) throw std::invalid_argument("triangles: more than can be indexed");
  // Counting sort by the lower vertex. A vertex is the lower one of three edges on average, so the remaining sort is
  // tiny.
  const auto for_each_half = [&](const auto& visit) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const Vec3i& v = mesh.triangles[t];
      if (repeats_a_vertex(v)) continue;
      const auto half = static_cast<std::uint32_t>(3 * t);
      visit(v.x, v.y, half), visit(v.y, v.z, half + 1), visit(v.z, v.x, half + 2);
    }
  };
  for_each_half([&](int a, int b, std::uint32_t) { ++begin_[static_cast<std::size_t>(std::min(a, b)) + 2]; });
  for (std::size_t v = 2; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  uses_.resize(begin_.back());
  // begin_[v + 1] is the insertion position for v; after the last insertion it is the end of v and the begin of v + 1.
  for_each_half([&](int a, int b, std::uint32_t half) {
    uses_[begin_[static_cast<std::size_t>(std::min(a, b)) + 1]++] = {std::max(a, b), 2 * half + (a > b ? 1U : 0U)};
  });
  base::parallel_for(mesh.vertices.size(), 1 << 14, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v)
      std::sort(uses_.begin() + begin_[v], uses_.begin() + begin_[v + 1],
                [](const Use& a, const Use& b) { return a.upper != b.upper ? a.upper < b.upper : a.code < b.code; });
  });
}

void EdgeTable::for_each_edge(const std::function<void(int, std::span<const Use>)>& visit) const {
  base::parallel_for(begin_.size() - 2, 1 << 13, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v)
      for (std::size_t i = begin_[v], j; i < begin_[v + 1]; i = j) {
        for (j = i + 1; j < begin_[v + 1] && uses_[j].upper == uses_[i].upper; ++j) {
        }
        visit(static_cast<int>(v), std::span(uses_).subspan(i, j - i));
      }
  });
}

std::size_t duplicates_at(const Mesh& mesh, std::span<const EdgeTable::Use> uses) {
  if (uses.size() < 2) return 0;
  thread_local std::vector<int> tips;
  tips.clear();
  for (const EdgeTable::Use& use : uses)
    if (const int tip = start_of(mesh, previous_half(use.half())); tip > use.upper) tips.push_back(tip);
  if (tips.size() < 2) return 0;
  std::sort(tips.begin(), tips.end());
  return tips.size() - static_cast<std::size_t>(std::unique(tips.begin(), tips.end()) - tips.begin());
}

Adjacency::Adjacency(const Mesh& mesh, const EdgeTable& edges) : across_(3 * mesh.triangles.size(), kNoEdge) {
  edges.for_each_edge([&](int, std::span<const EdgeTable::Use> uses) {
    if (uses.size() == 2) {
      const int a = uses[0].half(), b = uses[1].half();
      const bool same_way = uses[0].reversed() == uses[1].reversed();
      across_[a] = same_way ? kSameWay - b : b;
      across_[b] = same_way ? kSameWay - a : a;
    } else {
      for (const EdgeTable::Use& use : uses) across_[use.half()] = uses.size() == 1 ? kOpen : kCrowded;
    }
  });
}

}  // namespace riffler::mesh
