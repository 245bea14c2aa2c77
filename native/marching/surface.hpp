// A mesh under construction: what the stages after the hits share.
#pragma once

#include <cstdint>
#include <vector>

#include "marching/diagonal.hpp"
#include "marching/float_grid.hpp"
#include "marching/hits.hpp"
#include "mesh/mesh.hpp"

namespace riffler::marching {

/// A vertex that did not simply fall into its cell: the few that later stages look at.
struct Special {
  std::int32_t vertex;
  Vec3i cell;
  Vec3 anchor;  // where it is pulled to when triangles fold, cell units
  Vec3 other;   // until candidates are chosen, the candidate (the safe place if there is none); then the safe place
};

enum VertexMark : std::uint8_t {
  kSpecial = 1,    // has a Special
  kCandidate = 2,  // has a candidate that is not decided yet
  kNear = 8,       // corner of a quad under scrutiny
  kSharp = 32,     // its hits' normals differ: triangles round it may fold
  kMoved = 16,     // moved in the last round of `unfold`
};

struct Surface {
  const Lattice& lattice;
  const SignField& signs;
  const Counts& counts;
  const std::vector<Hit>& hits;
  FloatGrid grid;
  /// Quad n stands in triangles 2n and 2n + 1 as (c0, c1, c2), (c0, c2, c3), counter-clockwise round the edge seen from
  /// outside; the diagonal c0–c2 means nothing before the quads' stage.
  Mesh mesh;
  std::vector<std::uint8_t> marks;  // of each vertex
  std::vector<Special> specials;    // by vertex, ascending
  std::vector<Vec3i> sharp;         // cells of the vertices marked kSharp

  std::size_t quads() const { return mesh.triangles.size() / 2; }
  void set_corner(std::size_t quad, int n, std::int32_t vertex) {
    Vec3i& triangle = mesh.triangles[2 * quad + (n == 3)];
    (&triangle.x)[n - (n == 3)] = vertex;  // glm's operator branches
  }
  std::array<std::int32_t, 4> corners(std::size_t quad) const {
    const Vec3i &a = mesh.triangles[2 * quad], &b = mesh.triangles[2 * quad + 1];
    return {a.x, a.y, a.z, b.z};
  }
  Quad quad(std::size_t n, const LatticeEdge& edge) const;
  /// Writes the quad's two triangles along its best diagonal; false if none is valid.
  bool split(std::size_t n, const LatticeEdge& edge);
  /// The special of a vertex marked kSpecial.
  Special& special(std::int32_t vertex);
};

/// Columns of cells (i, j), each once, in order.
using Columns = std::vector<std::array<int, 2>>;
/// The columns whose edges can be edges of the given cells, or of cells next to them too (`rings` = 1).
Columns columns_near(const Surface& surface, const std::vector<Vec3i>& cells, int rings);
/// Quads of these columns with a corner that has one of the marks, ascending.
std::vector<std::uint32_t> quads_marked(const Surface& surface, const Columns& columns, std::uint8_t mark);

/// Places every vertex and enters it into the quads round its edges. Marks are 0, kSharp, kSpecial or both kSpecial and
/// kCandidate.
void place_vertices(Surface& surface, const Progress& progress);

/// Moves vertices from their safe places to their candidates, or part of the way, as long as all quads keep a valid
/// diagonal.
void choose_candidates(Surface& surface);

/// Gives every quad a diagonal whose triangles both face outward: their projections along the edge are positive. Of two
/// such it takes the one nearer the hit, else the shorter.
void choose_diagonals(Surface& surface, const Progress& progress);

/// Pulls vertices towards the middle of their cells where two triangles fold onto each other.
void unfold(Surface& surface);

}  // namespace riffler::marching
