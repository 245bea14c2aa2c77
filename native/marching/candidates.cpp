#include <algorithm>

#include "geom/parallel.hpp"
#include "marching/surface.hpp"

namespace riffler::marching {

namespace {

/// The quads round the vertices that have a candidate.
class Surroundings {
 public:
  Surroundings(const Surface& surface, const std::vector<Vec3i>& cells)
      : quads_(quads_near(surface, cells, kCandidate)) {
    for (std::uint32_t n = 0; n < quads_.size(); ++n)
      for (const std::int32_t v : surface.corners(quads_[n].quad))
        if (surface.marks[v] & kCandidate) uses_.push_back({v, n});
    std::sort(uses_.begin(), uses_.end());
  }

  /// True if every quad round the vertex has a valid diagonal as its corners stand now.
  bool valid(const Surface& surface, std::int32_t vertex) const {
    for (auto u = std::lower_bound(uses_.begin(), uses_.end(), Use{vertex, 0}); u != uses_.end() && (*u)[0] == vertex;
         ++u)
      if (!valid_diagonals(surface.quad(quads_[static_cast<std::size_t>((*u)[1])])).any()) return false;
    return true;
  }

  std::vector<QuadRef>& quads() { return quads_; }

 private:
  using Use = std::array<std::int64_t, 2>;  // vertex, index into quads_
  std::vector<QuadRef> quads_;
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

void choose_candidates(Surface& surface, const Progress& progress) {
  // Cells whose indices have equal parities share no quad: eight groups, one after the other, whose members do not see
  // each other. The result depends neither on an order within a group nor on threads, and on near cells only.
  std::array<std::vector<Special*>, 8> groups;
  std::vector<Vec3i> cells;
  for (std::size_t n = 0; n < surface.bricks.size(); ++n)
    if (ActiveBrick* const brick = surface.bricks.active(n))
      for (Special& s : brick->specials) {
        if (!(surface.marks[s.vertex] & kCandidate)) continue;
        groups[(s.cell.x & 1) | (s.cell.y & 1) << 1 | (s.cell.z & 1) << 2].push_back(&s);
        cells.push_back(s.cell);
      }
  if (cells.empty()) return;
  Surroundings around(surface, cells);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    report(progress, static_cast<double>(g) / groups.size());
    parallel_for(groups[g].size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) advance(surface, around, *groups[g][n]);
    });
  }
  for (const auto& group : groups)
    for (const Special* s : group) surface.marks[s->vertex] = kSpecial;
  parallel_for(around.quads().size(), 1024, [&](std::size_t begin, std::size_t end) {
    HitFinder finder = surface.hits;
    for (std::size_t n = begin; n < end; ++n) surface.split(around.quads()[n], finder);
  });
  surface.moved = std::move(around.quads());
}

}  // namespace riffler::marching
