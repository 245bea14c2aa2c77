// Closed intervals along a ray.
#pragma once

#include <algorithm>
#include <limits>

namespace riffler::geom {

/// [near, far] along a ray; empty if near > far. The default is empty, the neutral element of include().
struct Interval {
  double near = std::numeric_limits<double>::infinity();
  double far = -std::numeric_limits<double>::infinity();

  bool empty() const { return !(near <= far); }
  double length() const { return empty() ? 0.0 : far - near; }
  /// Extends the interval to include s.
  void include(double s) { near = std::min(near, s), far = std::max(far, s); }
  /// The intersection.
  Interval cut(const Interval& o) const { return {std::max(near, o.near), std::min(far, o.far)}; }
  bool operator==(const Interval&) const = default;
};

}  // namespace riffler::geom

namespace riffler {
using geom::Interval;
}  // namespace riffler
