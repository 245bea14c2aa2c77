// The generalized winding number that an open surface owes to its boundary.
//
// Let S be a surface with boundary ∂S, and close it by the curtain that every boundary edge sweeps when it moves to
// infinity along the ray. A column never crosses the curtain, so
//     w(p) = n(p) + K(p),   n(p) = signed crossings of S below p,   K(p) = Σ Ω(a − p, b − p, e_z) / 4π
// over the boundary's directed edges ab, Ω the solid angle of the triangle whose third corner lies at infinity. (Solid
// angles: van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30(2), 1983.) In
// stereographic coordinates of the directions to a and b, half the solid angle is the argument of a complex number:
//     Ω / 2 = arg(t_a t_b + conj(α) β),   α = a_x + i a_y,   t_a = |a| + a_z,
// so that K modulo 1 is the argument of one product over the boundary: no arc tangents, no caps, no branches to follow.
// K is harmonic away from ∂S; its gradient is the Biot–Savart field of a current along ∂S.
#pragma once

#include <cmath>
#include <vector>

#include "dexel/from_mesh/boundary_field.hpp"
#include "dexel/from_mesh/field_points.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::dexel {

/// K near one place. Lengths in cells, z along the column.
class Field {
 public:
  /// K in the ball of `around`; refers to it.
  void fill(const BoundaryPieces& pieces, const Surroundings& around);
  bool smooth() const { return path_.empty(); }

  /// K at points within the ball, with `full` the whole of its gradient; bounds are those of the near edges.
  void at(const FieldPoints& points, bool full, FieldValues& values) const {
    evaluate_field(path_, around_->far, around_->centre, points, full, values);
  }
  /// Bounds of how far K may be from K(p) on the verticals through points, up to `reach` from them. Unlike those of
  /// curvature they stay useful beside edges. `curved` is that of the polynomial.
  void variation(const FieldPoints& points, const double* slope, double curved, double* variation) const {
    field_variation(path_, points, slope, rays_ + curved, variation);
  }
  /// Bound of the second derivatives of what the ways to infinity have.
  double rays() const { return rays_; }

 private:
  const Surroundings* around_ = nullptr;
  double rays_ = 0;
  std::vector<PathPoint> path_;
};

}  // namespace riffler::dexel
