#include <algorithm>

#include "marching/surface.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

/// The quads around the vertices that have a candidate.
class Surroundings {
 public:
  Surroundings(const Surface& surface, const std::vector<Vec3i>& cells)
      : quads_(quads_near(surface, cells, kCandidate)) {
    for (std::uint32_t n = 0; n < quads_.size(); ++n)
      for (const std::int32_t v : surface.corners(quads_[n].quad))
        if (surface.marks[v] & kCandidate) uses_.push_back({v, n});
    std::sort(uses_.begin(), uses_.end());
  }

  /// Whether every quad around the vertex has a valid diagonal with its current corners.
  bool valid(const Surface& surface, std::int32_t vertex) const {
    for (auto u = std::lower_bound(uses_.begin(), uses_.end(), Use{vertex, 0}); u != uses_.end() && (*u)[0] == vertex;
         ++u)
      if (!valid_diagonals(surface.quad(quads_[static_cast<std::size_t>((*u)[1])])).any()) return false;
    return true;
  }

  const std::vector<QuadRef>& quads() const { return quads_; }

 private:
  using Use = std::array<std::int64_t, 2>;  // vertex, index into quads_
  std::vector<QuadRef> quads_;
  std::vector<Use> uses_;
};

/// Moves a vertex from its safe place as far towards its candidate as its quads allow.
void advance(Surface& surface, const Surroundings& around, VertexChoice& special) {
  const FloatGrid& grid = surface.grid;
  const Vec3i& cell = special.at.cell;
  Vec3& place = surface.mesh.vertices[special.at.vertex];
  const Vec3 from = grid.to_cell(cell, special.safe), to = grid.to_cell(cell, special.candidate);
  for (double share = 1; share > 0; share -= 0.125) {
    const Vec3 part = from + share * (to - from);
    // Between the two places, it might coincide with another vertex of the cell.
    if (!special.alone && FloatGrid::in_cell(part)) break;
    place = share == 1 ? special.candidate : grid.near(cell, part);
    if (around.valid(surface, special.at.vertex)) break;
    place = special.safe;
  }
  special.chosen = place;
}

using Groups = std::array<std::vector<VertexChoice*>, 8>;

void add_to(Groups& groups, const std::vector<VertexChoice*>& specials) {
  for (VertexChoice* s : specials) {
    const Vec3i& cell = s->at.cell;
    groups[(cell.x & 1) | (cell.y & 1) << 1 | (cell.z & 1) << 2].push_back(s);
  }
}

}  // namespace

std::vector<VertexChoice*> undecided(Surface& surface, const std::vector<std::size_t>& bricks) {
  std::vector<VertexChoice*> found;
  for (const std::size_t n : bricks)
    for (VertexChoice& s : surface.bricks.active(n)->specials)
      if (surface.marks[s.at.vertex] & kCandidate) found.push_back(&s);
  return found;
}

void choose_candidates(Surface& surface, const std::vector<VertexChoice*>& open,
                       const std::vector<VertexChoice*>& known, const Progress& progress) {
  // Cells whose indices have equal parities share no quad. So the eight groups are processed one after the other, and
  // members of a group are independent. The result depends neither on the order within a group nor on threads, and only
  // on nearby cells.
  if (open.empty()) return;
  Groups open_groups, known_groups;
  add_to(open_groups, open), add_to(known_groups, known);
  std::vector<Vec3i> cells;
  for (const VertexChoice* s : open) cells.push_back(s->at.cell);
  const Surroundings around(surface, cells);
  for (const VertexChoice* s : known) surface.mesh.vertices[s->at.vertex] = s->safe;
  for (std::size_t g = 0; g < open_groups.size(); ++g) {
    base::report(progress, static_cast<double>(g) / open_groups.size());
    base::parallel_for(open_groups[g].size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) advance(surface, around, *open_groups[g][n]);
    });
    for (const VertexChoice* s : known_groups[g]) surface.mesh.vertices[s->at.vertex] = s->chosen;
  }
  base::parallel_for(around.quads().size(), 1024, [&](std::size_t begin, std::size_t end) {
    HitFinder finder = surface.hits;
    for (std::size_t n = begin; n < end; ++n) surface.split(around.quads()[n], finder);
  });
}

}  // namespace riffler::marching
