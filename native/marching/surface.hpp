// A mesh under construction: what the stages share.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/progress.hpp"
#include "marching/bricks.hpp"
#include "marching/diagonal.hpp"
#include "marching/float_grid.hpp"
#include "marching/hits.hpp"
#include "mesh/mesh.hpp"

namespace riffler::marching {

enum VertexMark : std::uint8_t {
  kSpecial = 1,    // its brick has a Special for it
  kCandidate = 2,  // has a candidate that is not decided yet
  kSharp = 4,      // its hits' normals differ: triangles round it may fold
  kMoved = 8,      // moved from where the bricks put it, or in the last round of `unfold`
};

/// A vertex and the cell that it belongs to.
struct CellVertex {
  std::int32_t vertex;
  Vec3i cell;
  bool operator==(const CellVertex& o) const { return vertex == o.vertex; }
  bool operator<(const CellVertex& o) const { return vertex < o.vertex; }
};

struct Surface {
  const Lattice& lattice;
  Bricks& bricks;
  HitFinder hits;  // each thread takes a copy
  FloatGrid grid;
  /// Quad n stands in triangles 2n and 2n + 1, as (c0, c1, c2), (c0, c2, c3) or as (c0, c1, c3), (c1, c2, c3); its
  /// corners are counter-clockwise round the edge seen from outside.
  Mesh mesh;
  std::vector<std::uint8_t> marks;  // of each vertex
  std::vector<QuadRef> moved;       // quads round the vertices that could choose their place

  Surface(const Volume& volume, const Lattice& on, Bricks& of)
      : lattice(on), bricks(of), hits(volume, on), grid(on), mesh{}, marks{}, moved{} {}

  std::array<std::int32_t, 4> corners(std::size_t quad) const {
    const Vec3i &a = mesh.triangles[2 * quad], &b = mesh.triangles[2 * quad + 1];
    if (a.x == b.x) return {a.x, a.y, a.z, b.z};
    return {a.x, a.y, b.y, a.z};
  }
  /// Which of a quad's triangles has the side from corner s to the next.
  std::uint32_t triangle_at(std::size_t quad, int s) const {
    const bool first = mesh.triangles[2 * quad].x == mesh.triangles[2 * quad + 1].x ? s < 2 : s % 3 == 0;
    return static_cast<std::uint32_t>(2 * quad + (first ? 0 : 1));
  }
  void write(std::size_t quad, const std::array<std::int32_t, 4>& c, int diagonal) {
    Vec3i &a = mesh.triangles[2 * quad], &b = mesh.triangles[2 * quad + 1];
    if (diagonal == 1)
      a = {c[0], c[1], c[3]}, b = {c[1], c[2], c[3]};
    else
      a = {c[0], c[1], c[2]}, b = {c[0], c[2], c[3]};
  }
  Quad quad(const QuadRef& ref) const;
  /// Writes the quad's two triangles along its best diagonal; false if none is valid.
  bool split(const QuadRef& ref, HitFinder& finder);
  /// The special of a vertex marked kSpecial.
  Special& special(const CellVertex& v);
};

/// The cell whose vertex is corner n of the quad that stands for an edge.
Vec3i corner_cell(const LatticeEdge& edge, int n);

/// Quads of the edges of these cells with a corner that has the mark; ascending.
std::vector<QuadRef> quads_near(const Surface& surface, const std::vector<Vec3i>& cells, std::uint8_t mark);

/// Finds the bricks that the surface runs through and numbers their quads and vertices. Throws std::invalid_argument if
/// there are more triangles than 32-bit indices can tell apart.
void number_bricks(Bricks& bricks, const Progress& progress);

/// Places every vertex and gives every quad a diagonal whose triangles both face outward: their projections along the
/// edge are positive. Of two such it takes the one nearer the hit, else the shorter. Marks are 0, kSharp, kSpecial or
/// both kSpecial and kCandidate.
void mesh_bricks(Surface& surface, const Progress& progress);

/// Moves vertices from their safe places to their candidates, or part of the way, as long as all quads keep a valid
/// diagonal.
void choose_candidates(Surface& surface, const Progress& progress);

/// Pulls vertices towards the middle of their cells where two triangles fold onto each other.
void unfold(Surface& surface, const Progress& progress);

}  // namespace riffler::marching
