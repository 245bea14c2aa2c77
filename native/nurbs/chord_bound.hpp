// How far a rational Bézier net is from triangles between its points, bounded by its control points.
#pragma once

#include "nurbs/bezier.hpp"

namespace riffler::nurbs {

/// Upper bounds of the lengths of second derivatives over a net's unit square, mm. They hold everywhere in it.
struct SecondDerivatives {
  double uu = 0, uv = 0, vv = 0;

  /// Upper bound of the distance, mm, between surface and triangle at the same parameters, for any triangle whose
  /// corners are points of the surface with parameters in a rectangle of these sides. Proof: the error of linear
  /// interpolation is ½ Σ λ S''(dᵢ, dᵢ) with barycentric weights λ of the corners, dᵢ from the point to them, and the
  /// variance Σ λ dᵢ² of numbers in an interval is at most a quarter of its squared length. The bound for right
  /// triangles is that of Filip, Magedson & Markot, CAGD 3 (1986) 295.
  double chord(double side_u, double side_v) const {
    return (uu * side_u * side_u + 2 * uv * side_u * side_v + vv * side_v * side_v) / 8;
  }
};

SecondDerivatives second_derivatives(const Vec4* net, const Degrees& degrees);

/// The same at the middle of the net only, a lower bound of the largest.
SecondDerivatives second_derivatives_in_middle(const Vec4* net, const Degrees& degrees);

}  // namespace riffler::nurbs
