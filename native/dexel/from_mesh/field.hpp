// The part of the generalized winding number that comes from the boundary of an open surface.
//
// Let S be a surface with boundary ∂S. Close it with the curtain that every boundary edge sweeps when it moves to
// infinity along the ray. A column never crosses the curtain, so
//     w(p) = n(p) + K(p),   n(p) = signed crossings of S below p,   K(p) = Σ Ω(a − p, b − p, e_z) / 4π
// over the boundary's directed edges ab, Ω the solid angle of the triangle whose third corner lies at infinity. (Solid
// angles: van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30(2), 1983.) In
// stereographic coordinates of the directions to a and b, half the solid angle is the argument of a complex number:
//     Ω / 2 = arg(t_a t_b + conj(α) β),   α = a_x + i a_y,   t_a = |a| + a_z,
// Thus K modulo 1 is the argument of one product over the boundary: no arc tangents, no caps, no branches to track.
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
  /// Prepares K in the ball of `around`, which must outlive the field's use.
  void fill(const BoundaryPieces& pieces, const Surroundings& around);
  bool smooth() const { return path_.empty(); }

  /// K at points inside the ball, with the complete gradient if `full`. Bounds cover the near edges only.
  void at(const FieldPoints& points, bool full, FieldValues& values) const {
    evaluate_field(path_, around_->far, around_->centre, points, full, values);
  }
  /// Bounds on the change of K along the vertical through each point, up to its reach. Unlike bounds from curvature
  /// they stay useful next to edges. `curved` is the polynomial's bound.
  void variation(const FieldPoints& points, const double* slope, double curved, double* variation) const {
    field_variation(path_, points, slope, rays_ + curved, variation);
  }
  /// Bound on the second derivatives of the extensions to infinity.
  double rays() const { return rays_; }

 private:
  const Surroundings* around_ = nullptr;
  double rays_ = 0;
  std::vector<PathPoint> path_;
};

}  // namespace riffler::dexel
