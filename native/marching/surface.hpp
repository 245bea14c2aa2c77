// A mesh under construction: the state shared by the stages.
#pragma once

#include <cstdint>
#include <vector>

#include "marching/bricks.hpp"
#include "marching/cases.hpp"
#include "marching/diagonal.hpp"
#include "marching/float_grid.hpp"
#include "marching/hits.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::marching {

enum VertexMark : std::uint8_t {
  kSpecial = 1,    // its brick has a VertexChoice for it
  kCandidate = 2,  // has a candidate apart from its safe place
  kSharp = 4,      // its hits' normals differ: triangles around it may fold
  kMoved = 8,      // moved in the last round of `unfold`
  kPulled = 16,    // its brick has a MovedVertex for it
  kAnyMark = 255,  // for quads_near: all quads
};

struct Surface {
  const Lattice& lattice;
  Bricks& bricks;
  HitFinder hits;  // each thread takes a copy
  FloatGrid grid;
  /// Quad n is stored in triangles 2n and 2n + 1, as (c0, c1, c2), (c0, c2, c3) or as (c0, c1, c3), (c1, c2, c3). Its
  /// corners are counter-clockwise around the edge seen from outside.
  Mesh mesh;
  base::BulkVector<std::uint8_t> marks;  // of each vertex
  bool hollow = false;                   // leave out what plain bricks need only for all triangles

  Surface(const Volume& volume, const Lattice& on, Bricks& of)
      : lattice(on), bricks(of), hits(volume, on), grid(on), mesh{}, marks{} {}

  std::array<std::int32_t, 4> corners(std::size_t quad) const {
    const Vec3i &a = mesh.triangles[2 * quad], &b = mesh.triangles[2 * quad + 1];
    if (diagonal(quad) == 0) return {a.x, a.y, a.z, b.z};
    return {a.x, a.y, b.y, a.z};
  }
  /// Index of the quad's triangle that has the side from corner s to the next.
  std::uint32_t triangle_at(std::size_t quad, int s) const {
    const bool first = diagonal(quad) == 0 ? s < 2 : s % 3 == 0;
    return static_cast<std::uint32_t>(2 * quad + (first ? 0 : 1));
  }
  int diagonal(std::size_t quad) const { return mesh.triangles[2 * quad].x == mesh.triangles[2 * quad + 1].x ? 0 : 1; }
  void write(std::size_t quad, const std::array<std::int32_t, 4>& c, int diagonal) {
    Vec3i &a = mesh.triangles[2 * quad], &b = mesh.triangles[2 * quad + 1];
    if (diagonal == 1)
      a = {c[0], c[1], c[3]}, b = {c[1], c[2], c[3]};
    else
      a = {c[0], c[1], c[2]}, b = {c[0], c[2], c[3]};
  }
  Quad quad(const QuadRef& ref) const;
  /// Position of an edge's hit.
  Vec3 place_of(const LatticeEdge& edge, const Hit& hit) const {
    Vec3 place{lattice.at(0, edge.i), lattice.at(1, edge.j), lattice.at(2, edge.k)};
    (&place.x)[edge.axis] += hit.t() * lattice.pitch();
    return place;
  }
  /// Writes the quad's two triangles along its best diagonal. Returns false if no diagonal is valid.
  bool split(const QuadRef& ref, HitFinder& finder);
  /// The choice of a vertex marked kSpecial.
  VertexChoice& special(const CellVertex& v);
};

/// The cell whose vertex is corner n of the edge's quad.
inline Vec3i corner_cell(const LatticeEdge& edge, int n) {
  const int slot = corner_at(n, edge.rising);
  // The reverse of make_edge: cells below the edge have it on their upper sides.
  Vec3i cell{edge.i, edge.j, edge.k};
  if (slot == 3 || slot == 0) --cell[(edge.axis + 1) % 3];
  if (slot == 1 || slot == 0) --cell[(edge.axis + 2) % 3];
  return cell;
}

/// Appends the quads of a cell's edges with a corner that has the mark (kAnyMark: all of them).
void append_quads(const Surface& surface, const Vec3i& cell, std::uint8_t mark, std::vector<QuadRef>& out);

/// Quads of these cells' edges with a corner that has the mark (kAnyMark: all quads), ascending.
std::vector<QuadRef> quads_near(const Surface& surface, const std::vector<Vec3i>& cells, std::uint8_t mark);

/// Counts the edges and vertices of a brick; null if none of its cells has both signs.
std::unique_ptr<ActiveBrick> counted(const Bricks& bricks, std::size_t n);

/// Meshes bricks independently: places each vertex, and gives every quad a diagonal whose triangles both face outward
/// (their projections along the edge are positive). If both diagonals qualify, takes the one nearer to the hit, else
/// the shorter. Vertices with a candidate are put at their safe place. The bricks must already have their ranges in the
/// mesh.
void mesh_bricks(Surface& surface, const std::vector<std::size_t>& bricks, const Progress& progress);

/// Rewrites, in the quads of these bricks, the vertex numbers of the layer of cells below them, because the bricks
/// there have moved in the mesh.
void link_bricks(Surface& surface, const std::vector<std::size_t>& bricks);

/// The vertices with a candidate in these bricks.
std::vector<VertexChoice*> undecided(Surface& surface, const std::vector<std::size_t>& bricks);

/// Moves these vertices from their safe places to their candidates, or part of the distance, as long as all quads keep
/// a valid diagonal, and splits the quads around them again. Vertices in `known` move, in their turn, to the place that
/// they chose before.
void choose_candidates(Surface& surface, const std::vector<VertexChoice*>& open,
                       const std::vector<VertexChoice*>& known, const Progress& progress);

/// Bricks that `unfold` may change, by number; empty: all.
struct Region {
  std::vector<bool> bricks;
  std::vector<std::size_t> missing;  // bricks that `unfold` would have needed in their state before unfolding

  bool has(std::size_t brick) const { return bricks.empty() || bricks[brick]; }
};

/// Pulls vertices towards the middle of their cells where triangles fold onto each other. Starts with `quads`. If
/// `region.missing` is not empty afterwards, repeat the whole update with those bricks in the region.
void unfold(Surface& surface, const std::vector<QuadRef>& quads, Region& region, const Progress& progress);
/// Restores a brick's vertices to their places before `unfold`. Returns their cells; the quads around them must be
/// split again.
std::vector<Vec3i> undo_unfold(Surface& surface, std::size_t brick);

}  // namespace riffler::marching
