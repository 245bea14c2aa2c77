// Bricks whose part of the surface is one plane across a lattice axis, as are most bricks of a block.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "marching/surface.hpp"

namespace riffler::marching {

/// A brick is plain if its edges are 32 × 32 parallel ones whose hits lie in one plane across them, with the axis as
/// normal, and if the cells above these edges have its only vertices, one each. (u, v) is the place of such an edge or
/// cell along the two other axes, lower axis first. Whatever the axes are, its quad and its vertex have the number
/// 32 u + v among the brick's own; the quad's corners are the vertices of the cells from (u − 1, v − 1) to (u, v).
///
/// The vertices of (0, 0) to (30, 30) lie exactly in the plane unless `unfold` pulled one of them. So the quads from
/// (1, 1) to (30, 30) are a flat square, and the triangles of `flat_square` are the same surface. Where all triangles
/// are not needed, a brick may be made hollow: with the vertices of `flat_square`, and with quads in a margin of two at
/// each side only, which other bricks and `unfold` look at.
inline constexpr int kPlainLast = kBrickSide - 1;

inline bool has_hollow_quad(int u, int v) {
  const auto margin = [](int x) { return x <= 1 || x >= kPlainLast - 1; };
  return margin(u) || margin(v);
}
/// Whether a hollow brick has the vertex at (u, v), 0 ≤ u, v ≤ 31.
inline bool has_hollow_vertex(int u, int v) {
  const auto margin = [](int x) { return x <= 1 || x >= kPlainLast - 2; };
  const auto inner = [](int x) { return x == 7 || x == 15 || x == 22; };
  return margin(u) || margin(v) || (inner(u) && inner(v));
}

/// 128 triangles instead of 1800, with the same 120 vertices at their border.
struct FlatSquare {
  std::vector<std::uint32_t> vertices;                  // numbers among the brick's own, ascending
  std::vector<std::array<std::uint32_t, 3>> triangles;  // of such numbers, counter-clockwise from u to v
};
const FlatSquare& flat_square();

/// Makes what a hollow brick lacks.
void make_rest(Surface& surface, ActiveBrick& brick);
/// Makes what the bricks of these cells, and the bricks next to them, lack.
void make_rest_near(Surface& surface, const std::vector<CellVertex>& cells);

}  // namespace riffler::marching
