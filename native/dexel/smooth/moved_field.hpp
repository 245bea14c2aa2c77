// The material on a ray after points of the surface have moved.
#pragma once

#include <span>
#include <vector>

#include "dexel/smooth/end_points.hpp"
#include "dexel/smooth/relax.hpp"

namespace riffler::dexel {

/// A field value, negative in the material, and the direction in which it grows.
struct FieldValue {
  double value;  ///< approximate distance from the surface, mm
  Vec3 normal;   ///< unit, in the cyclic frame of the ray
};

/// Evaluates the moved points along one ray after another. They define a surface by an implicit moving least squares
/// field of their planes (Shen, O'Brien, Shewchuk, "Interpolating and Approximating Implicit Surfaces from Polygon
/// Soup", SIGGRAPH 2004; Kolluri, "Provably Good Moving Least Squares", 2008), which passes through the points.
///
/// Such a field is wrong near sharp edges, while the ray's own spans are exact. So only the *difference* between the
/// fields after and before the move counts: F = state · |before| + after − before, where state is −1 if the ray is in
/// the material and 1 outside. Where nothing has moved, nothing changes, even where the field is wrong.
class MovedField {
 public:
  MovedField(const std::vector<MovedPoint>& points, const Columns& columns, double pitch);

  /// Selects the ray at (u, v) in the cyclic frame of the columns. Returns the intervals along it in which the material
  /// may have changed: disjoint, in order, valid until the next call.
  std::span<const Interval> look_along(double u, double v);
  /// The field at w inside one of these intervals; `inside` is whether the ray itself is in the material at w.
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
  double farthest_ = 0;  // longest displacement of a point, mm
  std::vector<Interval> changes_;
  std::vector<std::uint32_t> order_;  // points near the ray, in their order along it after the move
  std::vector<Near> near_;
  std::vector<double> off_, along_;  // after the move: squared distance from the ray, coordinate along it
  std::vector<double> square_;       // squared distance from the queried place
};

}  // namespace riffler::dexel
