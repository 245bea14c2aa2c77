// What material becomes of a ray when points of the surface have moved.
#pragma once

#include <span>
#include <vector>

#include "dexel/smooth/end_points.hpp"
#include "dexel/smooth/relax.hpp"

namespace riffler::dexel {

/// A value that is negative in the material, and the direction in which it grows.
struct FieldValue {
  double value;  ///< about the distance from the surface, mm
  Vec3 normal;   ///< unit, cyclic frame of the ray
};

/// Moved points seen along one ray after another. The surface they say is that of an implicit moving least squares
/// field of their planes (Shen, O'Brien, Shewchuk, "Interpolating and Approximating Implicit Surfaces from Polygon
/// Soup", SIGGRAPH 2004; Kolluri, "Provably Good Moving Least Squares", 2008): it passes through the points.
///
/// Such a field errs beside sharp edges, and a ray knows more: its own spans. So only the *difference* between the
/// field of the points after and before counts: F = state · |before| + after − before, with the ray's own state, −1 in
/// the material and 1 beside it. Where nothing has moved, nothing changes, whatever the field makes of it.
class MovedField {
 public:
  MovedField(const std::vector<MovedPoint>& points, const Columns& columns, double pitch);

  /// To the ray at (u, v) in the cyclic frame of the columns. Returns where along it the material may have changed:
  /// disjoint, in order, valid until the next call.
  std::span<const Interval> look_along(double u, double v);
  /// At w within one of these, where the ray's own state is `inside` or not.
  FieldValue operator()(double w, bool inside);

 private:
  /// A point near the ray, relative to (u, v, 0).
  struct Near {
    Vec3 before, after, normal_before, normal_after;
  };

  void find_changes(double u, double v);
  Interval change_around(const Vec3& q, const Vec3& normal, double way) const;
  void gather(double u, double v);

  const std::vector<MovedPoint>& points_;
  const Columns& columns_;
  double pitch_, reach_;
  double farthest_ = 0;  // way of any point
  std::vector<Interval> changes_;
  std::vector<std::uint32_t> order_;  // points near the ray, as they come along it after the move
  std::vector<Near> near_;
  std::vector<double> off_, along_;  // after: squared distance from the ray, coordinate along it
  std::vector<double> square_;       // of the distance from the place asked for
};

}  // namespace riffler::dexel
