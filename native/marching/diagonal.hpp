// Chooses the diagonal of a quad around a lattice edge.
#pragma once

#include <array>

#include "marching/lattice.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::marching {

/// Corners of a quad, counter-clockwise seen from outside, and the edge that it surrounds.
struct Quad {
  std::array<Vec3, 4> corner;
  int axis;     // of the edge
  double side;  // +1 if outside is towards +axis, −1 if towards −axis
};

struct Diagonals {
  bool first, second;  // whether both triangles of c0–c2, of c1–c3, have positive area projected along the edge
  bool any() const { return first || second; }
};

/// Exact: coordinates are multiples of one step with at most 24 bits, so products fit a double.
Diagonals valid_diagonals(const Quad& quad);

/// mm. Heights of two diagonals over their edge count as equal if they differ by less: two rounding steps at each end.
inline double diagonal_tie(const Lattice& lattice) {
  return 4 * lattice.step();
}

/// Returns 0 for c0–c2, 1 for c1–c3, −1 if neither is valid. If both are valid, chooses the one whose surface passes
/// nearer to the hit; if both are within `tie` (mm) of each other, the shorter one.
int choose_diagonal(const Quad& quad, const Vec3& hit, double tie);

}  // namespace riffler::marching
