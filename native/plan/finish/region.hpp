// The area inside closed curves, seen along the axis.
#pragma once

#include <array>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// The points inside an odd number of closed curves. Edges are sorted into bands of y, so that a test visits only the
/// edges of one band: areas of remaining stock have thousands of edges.
class Region {
 public:
  explicit Region(const std::vector<std::vector<Vec2>>& curves);

  bool empty() const { return bands_.empty(); }
  bool holds(const Vec2& p) const;
  /// Whether a point of the area is at most `reach` (mm) from `p`.
  bool within(const Vec2& p, double reach) const;

 private:
  std::size_t band(double y) const;

  std::vector<std::vector<std::array<Vec2, 2>>> bands_;
  double low_ = 0, high_ = 0;  // range of y
};

}  // namespace riffler::plan
