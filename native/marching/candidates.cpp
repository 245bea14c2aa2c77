#include <atomic>

#include "geom/parallel.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

/// Rejects the candidates that could leave this quad without a valid diagonal, whatever the others decide.
void test_combinations(Surface& surface, std::size_t n) {
  const LatticeEdge edge = surface.counts.locate(surface.signs, n);
  const auto corner = surface.corners(n);
  Quad quad = surface.quad(n, edge);
  const std::array<Vec3, 4> safe = quad.corner;
  std::array<Vec3, 4> candidate = safe;
  unsigned open = 0;
  for (int c = 0; c < 4; ++c)
    if (std::atomic_ref(surface.marks[corner[c]]).load(std::memory_order_relaxed) & kCandidate)
      open |= 1u << c, candidate[c] = surface.special(corner[c]).other;
  unsigned rejected = 0;
  for (unsigned taken = open; taken; taken = (taken - 1) & open) {
    for (int c = 0; c < 4; ++c) quad.corner[c] = taken >> c & 1 ? candidate[c] : safe[c];
    if (!valid_diagonals(quad).any()) rejected |= taken;
  }
  for (int c = 0; c < 4; ++c)
    if (rejected >> c & 1) std::atomic_ref(surface.marks[corner[c]]).fetch_or(kRejected, std::memory_order_relaxed);
}

}  // namespace

std::vector<std::uint32_t> quads_marked(const Surface& surface, std::uint8_t mark) {
  constexpr std::size_t grain = 1 << 14;
  std::vector<std::vector<std::uint32_t>> found((surface.quads() + grain - 1) / grain);
  parallel_for(surface.quads(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const auto c = surface.corners(n);
      const std::vector<std::uint8_t>& m = surface.marks;
      if ((m[c[0]] | m[c[1]] | m[c[2]] | m[c[3]]) & mark) found[begin / grain].push_back(static_cast<std::uint32_t>(n));
    }
  });
  std::vector<std::uint32_t> all;
  for (const auto& chunk : found) all.insert(all.end(), chunk.begin(), chunk.end());
  return all;
}

void choose_candidates(Surface& surface) {
  if (surface.specials.empty()) return;
  const std::vector<std::uint32_t> quads = quads_marked(surface, kCandidate);
  parallel_for(quads.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) test_combinations(surface, quads[n]);
  });
  for (Special& s : surface.specials) {
    std::uint8_t& mark = surface.marks[s.vertex];
    if (mark & kRejected)
      s.other = surface.mesh.vertices[s.vertex];
    else
      std::swap(surface.mesh.vertices[s.vertex], s.other);
    mark = kSpecial;
  }
}

}  // namespace riffler::marching
