// The diagonal of a quad round a lattice edge.
#pragma once

#include <array>

#include "marching/lattice.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::marching {

/// Corners of a quad, counter-clockwise seen from outside, and the edge it stands round.
struct Quad {
  std::array<Vec3, 4> corner;
  int axis;     // of the edge
  double side;  // +1 where outside lies up the axis, −1 where down
};

struct Diagonals {
  bool first, second;  // c0–c2 and c1–c3: both their triangles have positive area projected along the edge
  bool any() const { return first || second; }
};

/// Exact: coordinates are multiples of one step with at most 24 bits, so their products fit a double.
Diagonals valid_diagonals(const Quad& quad);

/// Heights of two diagonals over their edge that differ by less are the same, mm: two steps of rounding at each end.
inline double diagonal_tie(const Lattice& lattice) {
  return 4 * lattice.step();
}

/// 0 for c0–c2, 1 for c1–c3, −1 if neither is valid. Of two valid ones the one whose surface passes nearer the hit,
/// and where both do within `tie` (mm), the shorter.
int choose_diagonal(const Quad& quad, const Vec3& hit, double tie);

}  // namespace riffler::marching
