#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/sort_unique.hpp"
#include "marching/plain_brick.hpp"
#include "marching/surface.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::marching {

namespace {

constexpr double kFolded = -0.999985;  // cosine between the normals of two triangles at an edge, 0.3° from a fold
constexpr int kPatient = 3;            // number of rounds in which only the ends of a fold are pulled

Vec3 normal(const Mesh& mesh, const Vec3i& t) {
  const Vec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
  return glm::cross(b - a, c - a);
}

bool folded(const Mesh& mesh, std::size_t s, std::size_t t) {
  const Vec3 a = normal(mesh, mesh.triangles[s]), b = normal(mesh, mesh.triangles[t]);
  return glm::dot(a, b) < kFolded * std::sqrt(glm::dot(a, a) * glm::dot(b, b));
}

CellVertex corner(const Surface& surface, const QuadRef& ref, int n) {
  return {surface.corners(ref.quad)[n], corner_cell(ref.edge, n)};
}

/// The side of a quad that connects two vertices, in either direction; −1 if there is none.
int side_between(const std::array<std::int32_t, 4>& c, std::int32_t a, std::int32_t b) {
  for (int s = 0; s < 4; ++s)
    if ((c[s] == a && c[(s + 1) & 3] == b) || (c[s] == b && c[(s + 1) & 3] == a)) return s;
  return -1;
}

struct SideRef {
  QuadRef quad;
  int side;
};

/// The quad across the side from corner s to the next. It belongs to another edge of the face that the two corners'
/// cells share.
SideRef across(const Surface& surface, const QuadRef& ref, int s) {
  const CellVertex a = corner(surface, ref, s), b = corner(surface, ref, (s + 1) & 3);
  const Vec3i origin = glm::max(a.cell, b.cell);
  const int along = a.cell.x != b.cell.x ? 0 : a.cell.y != b.cell.y ? 1 : 2;
  for (int d = 1; d <= 2; ++d)
    for (int side = 0; side < 2; ++side) {
      const int axis = (along + d) % 3;
      Vec3i from = origin;
      from[(along + 3 - d) % 3] += side;
      Vec3i to = from;
      ++to[axis];
      const bool inside = surface.bricks.at(from.x, from.y, from.z);
      if (inside == surface.bricks.at(to.x, to.y, to.z)) continue;
      const LatticeEdge edge{axis, from.x, from.y, from.z, !inside};
      const std::uint32_t quad = surface.bricks.quad_of(edge);
      if (quad == ref.quad) continue;
      const int there = side_between(surface.corners(quad), a.vertex, b.vertex);
      if (there >= 0) return {{quad, edge}, there};
    }
  throw std::logic_error("a quad of the mesh without a neighbour");
}

/// Vertices that fold, and the bricks that were examined.
struct Folds {
  std::vector<CellVertex> ends;
  std::vector<std::size_t> seen;

  /// Most are the one before.
  void see(std::size_t brick) {
    if (seen.empty() || seen.back() != brick) seen.push_back(brick);
  }
  void tidy() { base::sort_unique(ends), base::sort_unique(seen); }
};

/// Adds the corners of one of a quad's triangles.
void add_corners(const Surface& surface, const QuadRef& ref, std::uint32_t triangle, Folds& out) {
  const Vec3i& t = surface.mesh.triangles[triangle];
  for (int n = 0; n < 4; ++n)
    if (const CellVertex v = corner(surface, ref, n); v.vertex == t.x || v.vertex == t.y || v.vertex == t.z)
      out.ends.push_back(v);
}

/// `whole`: add all corners of two triangles that fold, not only the two that they share. If the other two corners
/// coincide, these have to separate.
void look_at(const Surface& surface, const QuadRef& ref, bool whole, bool note, Folds& out) {
  const auto see = [&](const QuadRef& quad) {
    for (int n = 0; note && n < 4; ++n) out.see(surface.bricks.index_of(corner_cell(quad.edge, n)));
  };
  see(ref);
  if (folded(surface.mesh, 2 * std::size_t{ref.quad}, 2 * std::size_t{ref.quad} + 1))
    for (int n = 0; n < 4; ++n) out.ends.push_back(corner(surface, ref, n));
  for (int s = 0; s < 4; ++s) {
    const SideRef beyond = across(surface, ref, s);
    see(beyond.quad);
    const std::uint32_t here = surface.triangle_at(ref.quad, s),
                        there = surface.triangle_at(beyond.quad.quad, beyond.side);
    if (!folded(surface.mesh, here, there)) continue;
    if (whole)
      add_corners(surface, ref, here, out), add_corners(surface, beyond.quad, there, out);
    else
      out.ends.push_back(corner(surface, ref, s)), out.ends.push_back(corner(surface, ref, (s + 1) & 3));
  }
}

/// Ends of the edges at which a triangle of these quads folds onto its neighbour, or all corners of the two; ascending.
std::vector<CellVertex> folded_vertices(const Surface& surface, const std::vector<QuadRef>& quads, bool whole,
                                        Region& region) {
  constexpr std::size_t chunk = 1024;
  const bool note = !region.bricks.empty();
  std::vector<Folds> parts((quads.size() + chunk - 1) / chunk);
  base::parallel_for(quads.size(), chunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t q = begin; q < end; ++q) look_at(surface, quads[q], whole, note, parts[begin / chunk]);
    parts[begin / chunk].tidy();
  });
  Folds all;
  for (const Folds& part : parts) {
    all.ends.insert(all.ends.end(), part.ends.begin(), part.ends.end());
    all.seen.insert(all.seen.end(), part.seen.begin(), part.seen.end());
  }
  all.tidy();
  for (const std::size_t brick : all.seen)
    if (!region.has(brick) && !surface.bricks.active(brick)->pulled.empty()) region.missing.push_back(brick);
  return std::move(all.ends);
}

/// Moves a vertex and records its original place. Returns false if it was there already.
bool move(Surface& surface, const CellVertex& v, const Vec3& place, Region& region) {
  const std::size_t brick = surface.bricks.index_of(v.cell);
  if (!region.has(brick)) region.missing.push_back(brick);
  Vec3& now = surface.mesh.vertices[v.vertex];
  if (!(surface.marks[v.vertex] & kPulled)) surface.bricks.active(brick)->pulled.push_back({v, now});
  surface.marks[v.vertex] |= kPulled;
  return std::exchange(now, place) != place;
}

/// Siblings have neighbouring numbers, and only siblings can coincide.
bool coincides(const Mesh& mesh, std::int32_t vertex, const Vec3& place) {
  const auto last = std::min<std::int32_t>(vertex + 3, static_cast<std::int32_t>(mesh.vertices.size()) - 1);
  for (std::int32_t v = std::max(0, vertex - 3); v <= last; ++v)
    if (v != vertex && mesh.vertices[v] == place) return true;
  return false;
}

/// Moves a vertex part of the distance to its anchor; a vertex at its candidate first moves towards its safe place.
/// Returns false if it does not move.
bool pull(Surface& surface, const CellVertex& v, double share, Region& region) {
  const Vec3 place = surface.mesh.vertices[v.vertex];
  const FloatGrid& grid = surface.grid;
  VertexChoice* const special = surface.marks[v.vertex] & kSpecial ? &surface.special(v) : nullptr;
  if (special && place != special->fallback) {
    const Vec3 from = grid.to_cell(v.cell, place), to = grid.to_cell(v.cell, special->fallback);
    const Vec3 part = from + share * (to - from);
    // Three tries on the path, none of which may coincide with another vertex of the cell.
    const bool whole = share >= 0.5 || (!special->alone && FloatGrid::in_cell(part));
    return move(surface, v, whole ? special->fallback : grid.near(v.cell, part), region);
  }
  const Vec3 anchor = special ? special->anchor : Vec3(0.5);
  const Vec3 from = glm::clamp(grid.to_cell(v.cell, place), 0.0, 1.0);
  const Vec3 to = grid.free_place(v.cell, grid.inside(v.cell, from + share * (anchor - from)),
                                  [&](const Vec3& p) { return coincides(surface.mesh, v.vertex, p); });
  if (special) special->fallback = to;
  return move(surface, v, to, region);
}

/// Splits the quads around moved vertices again. If a neighbour's candidate no longer allows a valid diagonal, the
/// neighbour also returns to its safe place and joins the moved ones. With safe places alone there is always a
/// diagonal.
void split_again(Surface& surface, std::vector<CellVertex>& moved, std::vector<Vec3i>& cells, Region& region) {
  for (std::size_t done = 0; done < moved.size();) {
    for (; done < moved.size(); ++done) {
      surface.marks[moved[done].vertex] |= kMoved;
      cells.push_back(moved[done].cell);
    }
    for (const QuadRef& ref : quads_near(surface, cells, kMoved)) {
      if (surface.split(ref, surface.hits)) continue;
      for (int n = 0; n < 4; ++n) {
        const CellVertex v = corner(surface, ref, n);
        if (!(surface.marks[v.vertex] & kSpecial)) continue;
        const Vec3& safe = surface.special(v).fallback;
        if (surface.mesh.vertices[v.vertex] == safe) continue;
        move(surface, v, safe, region);
        moved.push_back(v);
      }
    }
  }
}

}  // namespace

void unfold(Surface& surface, const std::vector<QuadRef>& quads, Region& region, const Progress& progress) {
  std::vector<CellVertex> moved = folded_vertices(surface, quads, false, region);
  // After six rounds vertices reach their anchors. From then on each moves at most twice, so the rounds terminate;
  // there are many if a fold runs along a sheet whose sides coincide.
  double share = 0.04;
  for (int round = 0; !moved.empty(); ++round, share = std::min(1.0, 2 * share)) {
    base::report(progress, round / (round + 8.0));
    make_rest_near(surface, moved);
    bool any = share < 1;
    for (const CellVertex& v : moved) any |= pull(surface, v, share, region);
    if (!any) break;
    std::vector<Vec3i> cells;
    split_again(surface, moved, cells, region);
    std::vector<CellVertex> next =
        folded_vertices(surface, quads_near(surface, cells, kMoved), round >= kPatient, region);
    for (const CellVertex& v : moved) surface.marks[v.vertex] &= static_cast<std::uint8_t>(~kMoved);
    moved = std::move(next);
  }
}

std::vector<Vec3i> undo_unfold(Surface& surface, std::size_t brick) {
  ActiveBrick& active = *surface.bricks.active(brick);
  std::vector<Vec3i> cells;
  for (const MovedVertex& p : active.pulled) {
    cells.push_back(p.at.cell);
    surface.mesh.vertices[p.at.vertex] = p.before;
    surface.marks[p.at.vertex] &= static_cast<std::uint8_t>(~kPulled);
  }
  active.pulled.clear();
  for (VertexChoice& s : active.specials) s.fallback = s.safe;
  return cells;
}

}  // namespace riffler::marching
