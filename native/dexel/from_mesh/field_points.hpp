// The boundary sums that Field evaluates, at eight points at a time in SIMD lanes selected at run time.
#pragma once

#include <span>

#include "base/lanes.hpp"
#include "dexel/from_mesh/local_expansion.hpp"

namespace riffler::dexel {

/// Number of points evaluated together.
inline constexpr int kPoints = base::kLanes;

/// One point of the near polylines. Lengths in cells.
struct PathPoint {
  double x, y, z;
  bool joined;  ///< an edge connects the previous point with this one
  bool finite;  ///< if not, the point is at infinity in the direction (x, y, z) of length 1
  bool ends;    ///< the edge is the last of a piece (boundary_field.hpp)
  /// For the edge that ends here, if both its ends are finite: 1 / length² (0 for length 0), and half the length.
  double inverse_square, half_length;
  /// For the piece that ends here: 1.5 times the area of a surface that it spans; infinity if the piece is not a loop.
  double area;
};

struct FieldPoints {
  double x[kPoints], y[kPoints], z[kPoints];
  /// Half sizes of the boxes around the points in which the bounds hold.
  double half_x[kPoints], half_y[kPoints], half_z[kPoints];
};

struct FieldValues {
  double phase[kPoints];                         ///< of K, in [−½, ½]: 0 where K = ½
  double gx[kPoints], gy[kPoints], gz[kPoints];  ///< gradient of K
  double curvature[kPoints];  ///< bound on the second derivatives of the near edges' K; above 1e20: an edge may cross
                              ///< the box
};

/// K at the points, from the near path and the polynomial `far` about `centre`. Omits gx and gy unless `full`.
void evaluate_field(std::span<const PathPoint> path, const LocalExpansion& far, const Vec3& centre,
                    const FieldPoints& points, bool full, FieldValues& values);

/// Bounds on the change of K along the vertical through each p, up to half_z from p. `slope` is K's slope there and
/// `curvature` bounds the second derivative of the extensions to infinity and of the polynomial. Infinity if the
/// boundary has a vertex there.
void field_variation(std::span<const PathPoint> path, const FieldPoints& points, const double* slope, double curvature,
                     double* variation);

}  // namespace riffler::dexel
