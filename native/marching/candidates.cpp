#include <algorithm>
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

Columns columns_near(const Surface& surface, const std::vector<Vec3i>& cells, int rings) {
  const int ni = surface.lattice.cells(0), nj = surface.lattice.cells(1);
  std::vector<bool> wanted(static_cast<std::size_t>(ni) * nj);
  Columns columns;
  for (const Vec3i& cell : cells)
    for (int i = std::max(0, cell.x - rings); i <= std::min(ni - 1, cell.x + 1 + rings); ++i)
      for (int j = std::max(0, cell.y - rings); j <= std::min(nj - 1, cell.y + 1 + rings); ++j) {
        const std::size_t n = static_cast<std::size_t>(i) * nj + j;
        if (!wanted[n]) columns.push_back({i, j});
        wanted[n] = true;
      }
  std::sort(columns.begin(), columns.end());
  return columns;
}

std::vector<std::uint32_t> quads_marked(const Surface& surface, const Columns& columns, std::uint8_t mark) {
  std::vector<std::uint32_t> found;
  for (const auto& [i, j] : columns)
    for (std::size_t n = surface.counts.edge(i, j, 0); n < surface.counts.edge_after(i, j); ++n) {
      const auto c = surface.corners(n);
      const std::vector<std::uint8_t>& m = surface.marks;
      if ((m[c[0]] | m[c[1]] | m[c[2]] | m[c[3]]) & mark) found.push_back(static_cast<std::uint32_t>(n));
    }
  return found;
}

void choose_candidates(Surface& surface) {
  if (surface.specials.empty()) return;
  std::vector<Vec3i> cells;
  for (const Special& s : surface.specials)
    if (surface.marks[s.vertex] & kCandidate) cells.push_back(s.cell);
  const std::vector<std::uint32_t> quads = quads_marked(surface, columns_near(surface, cells, 0), kCandidate);
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
