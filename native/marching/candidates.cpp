#include <algorithm>

#include "geom/parallel.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

/// The quads round the vertices that have a candidate.
class Surroundings {
 public:
  explicit Surroundings(const Surface& surface, const std::vector<Vec3i>& cells)
      : quads_(quads_marked(surface, columns_near(surface, cells, 0), kCandidate)), edges_(quads_.size()) {
    for (std::uint32_t n = 0; n < quads_.size(); ++n) {
      edges_[n] = surface.counts.locate(surface.signs, quads_[n]);
      for (const std::int32_t v : surface.corners(quads_[n]))
        if (surface.marks[v] & kCandidate) uses_.push_back({v, n});
    }
    std::sort(uses_.begin(), uses_.end());
  }

  /// True if every quad round the vertex has a valid diagonal as its corners stand now.
  bool valid(const Surface& surface, std::int32_t vertex) const {
    for (auto u = std::lower_bound(uses_.begin(), uses_.end(), Use{vertex, 0}); u != uses_.end() && (*u)[0] == vertex;
         ++u) {
      const auto n = static_cast<std::size_t>((*u)[1]);
      if (!valid_diagonals(surface.quad(quads_[n], edges_[n])).any()) return false;
    }
    return true;
  }

 private:
  using Use = std::array<std::int64_t, 2>;  // vertex, index into quads_
  std::vector<std::uint32_t> quads_;
  std::vector<LatticeEdge> edges_;
  std::vector<Use> uses_;
};

/// Moves a vertex from its safe place as far towards its candidate as its quads let it.
void advance(Surface& surface, const Surroundings& around, Special& special) {
  const FloatGrid& grid = surface.grid;
  Vec3& place = surface.mesh.vertices[special.vertex];
  const Vec3 safe = place, from = grid.to_cell(special.cell, safe), to = grid.to_cell(special.cell, special.other);
  for (double share = 1; share > 0; share -= 0.125) {
    place = share == 1 ? special.other : grid.near(special.cell, from + share * (to - from));
    if (around.valid(surface, special.vertex)) break;
    place = safe;
  }
  special.other = safe;
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
  // Cells whose indices have equal parities share no quad: eight groups, one after the other, whose members do not see
  // each other. The result depends neither on an order within a group nor on threads, and on near cells only.
  std::array<std::vector<Special*>, 8> groups;
  std::vector<Vec3i> cells;
  for (Special& s : surface.specials) {
    if (!(surface.marks[s.vertex] & kCandidate)) continue;
    groups[(s.cell.x & 1) | (s.cell.y & 1) << 1 | (s.cell.z & 1) << 2].push_back(&s);
    cells.push_back(s.cell);
  }
  const Surroundings around(surface, cells);
  for (const auto& group : groups)
    parallel_for(group.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) advance(surface, around, *group[n]);
    });
  for (Special& s : surface.specials) surface.marks[s.vertex] = kSpecial;
}

}  // namespace riffler::marching
