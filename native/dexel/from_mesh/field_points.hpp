// The sums over a boundary that Field evaluates, at eight points at a time in vector lanes, chosen at run time.
#pragma once

#include <span>

#include "base/lanes.hpp"
#include "dexel/from_mesh/local_expansion.hpp"

namespace riffler::dexel {

/// Points that are evaluated together.
inline constexpr int kPoints = base::kLanes;

/// One point of the polylines that are near. Lengths in cells.
struct PathPoint {
  double x, y, z;
  bool joined;  ///< an edge leads here from the point before
  bool finite;  ///< otherwise the point lies at infinity, in the direction (x, y, z) of length 1
  bool ends;    ///< the edge is the last of a piece (boundary_field.hpp)
  /// Of the edge that leads here, if both its ends are finite: 1 / length² (0 for no length), and half the length.
  double inverse_square, half_length;
  /// Of the piece that ends here: 1.5 times the area of a surface that it spans; infinity where it is no loop.
  double area;
};

struct FieldPoints {
  double x[kPoints], y[kPoints], z[kPoints];
  double half_x[kPoints], half_y[kPoints], half_z[kPoints];  ///< of the boxes about the points in which bounds hold
};

struct FieldValues {
  double phase[kPoints];                         ///< of K: 0 where K = ½, in [−½, ½]
  double gx[kPoints], gy[kPoints], gz[kPoints];  ///< K's gradient
  double curvature[kPoints];  ///< bound of the second derivatives of the near edges' K; above 1e20: an edge may be in
                              ///< the box
};

/// K at points: the near path and the polynomial `far` about `centre`. gx and gy are left out unless `full`.
void evaluate_field(std::span<const PathPoint> path, const LocalExpansion& far, const Vec3& centre,
                    const FieldPoints& points, bool full, FieldValues& values);

/// Bounds of how far K may be from K(p) on the vertical through p, up to half_z from p, given K's slope there and a
/// bound of the second derivative that points at infinity and polynomial have; infinity where the boundary has a vertex
/// there.
void field_variation(std::span<const PathPoint> path, const FieldPoints& points, const double* slope, double curvature,
                     double* variation);

}  // namespace riffler::dexel
