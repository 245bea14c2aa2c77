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

#include "dexel/boundary_field.hpp"
#include "dexel/field_sum.hpp"
#include "geom/vec.hpp"

namespace riffler {

/// K near one place. Lengths in cells, z along the column.
class Field {
 public:
  /// K modulo 1 as a phase in (−½, ½] that is 0 where K = ½, and dK/dz.
  struct Value {
    double phase, slope;
  };

  /// K in the ball of `around`; refers to both.
  void fill(const BoundaryPieces& pieces, const Surroundings& around);

  /// K at the centre of a box within the ball as a phase, with its gradient there, and a bound of how far K in the box
  /// may be from that tangent plane: infinity where an edge may pass through.
  struct Tangent {
    double phase, remainder;
    Vec3 gradient;
  };
  /// `curved` is that of the polynomial for the box.
  Tangent tangent(const Vec3& centre, const Vec3& half, double curved);

  /// Prepares `curvature` and `variation` for the box about the centre that the ball encloses.
  void enclose(const Vec3& half);

  /// Prepares `at` for the column through (u, v).
  void set_column(double u, double v);
  Value at(double z) const;
  /// Phase and gradient; sets the column through p.
  double at(const Vec3& p, Vec3& gradient);

  /// Upper bound of K's second derivative by z within `half` of z on the column set; infinity on an edge.
  double curvature(double z, double half) const;
  /// How far K within `half` of z on the column set may be from K(z), given dK/dz there. Unlike `curvature` it stays
  /// useful beside edges: one edge's share of K never turns back along a column, for the sign of
  /// dK/dz = (a × b)_z (|a| + |b|) / (4π |a| |b| (|a| |b| + a·b)) is that of a constant.
  double variation(double z, double half, double slope) const;

 private:
  EdgeArrays edge_arrays() const {
    return {ax_.data(),    ay_.data(),     z_.data(),      rr_.data(),      dot_.data(),
            cross_.data(), joined_.data(), finite_.data(), scratch_.data(), z_.size() - 1};
  }
  void add_point(const Vec3& p, bool joined, bool finite = true);
  void set_edges(double u, double v);

  const BoundaryPieces* pieces_ = nullptr;
  const Surroundings* around_ = nullptr;
  double rays_ = 0;  // curvature of the ways to infinity
  // The points of polylines, one after the other, padded to a multiple of kLanes. See EdgeArrays.
  std::vector<double> x_, y_, z_, joined_, finite_;
  std::vector<int> close_;  // pieces whose curvature depends on the place
  double curvature_ = 0;    // of all others, along z

  double u_ = 0, v_ = 0;
  // Of each point relative to the column, and of the edge that leads to it: Re and Im of conj(α) β.
  std::vector<double> ax_, ay_, rr_, dot_, cross_;
  LocalExpansion::Column far_{};  // in z − centre
  mutable std::vector<double> scratch_;
};

/// A direction in stereographic coordinates up to a positive factor: (t : α) = (t : f α), rr = |α|².
struct Stereographic {
  double t, f;
  Stereographic(double z, double rr) {
    const double length = std::sqrt(rr + z * z);
    t = z < 0 ? rr : length + z, f = z < 0 ? length - z : 1.0;
  }
};

/// Distance of p from the segment ab.
double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b);
/// Bound of the norm of the second derivatives of K of an edge at the distance d or more from it.
double edge_curvature(double length, double d);

}  // namespace riffler
