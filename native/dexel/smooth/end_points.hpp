// The span ends of a tri-dexel volume as points of its surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// A point where material ends; world frame, mm.
struct EndPoint {
  Vec3 place;
  Vec3 normal;  ///< unit, out of the material
  /// Area of surface that the point represents, as a multiple of h²: an area h² has |nx| + |ny| + |nz| ends of all
  /// three grids together.
  double area;
  bool held;  ///< lies in the protected region
};

/// All span ends within `radius` (mm) of `centre`. `protect` (may be null) defines `held`. Their order depends only on
/// the volume.
std::vector<EndPoint> end_points(const Volume& volume, const Vec3& centre, double radius, const Volume* protect);

/// Points sorted into columns of square cells along one axis, for repeated neighbour searches.
class Columns {
 public:
  /// `places`: world frame. `side`: side of a cell, mm.
  Columns(Axis axis, std::vector<Vec3> places, double side);

  Axis axis() const { return axis_; }
  /// Calls f(first, last) for ranges of `order` that together contain all points in `box` (cyclic frame), and possibly
  /// others.
  template <class F>
  void for_each_run(const Box3& box, const F& f) const {
    const int u0 = cell(box.lower.x, lower_.x, nu_), u1 = cell(box.upper.x, lower_.x, nu_);
    const int v0 = cell(box.lower.y, lower_.y, nv_), v1 = cell(box.upper.y, lower_.y, nv_);
    for (int u = u0; u <= u1; ++u)
      for (int v = v0; v <= v1; ++v) {
        const std::size_t column = static_cast<std::size_t>(u) * nv_ + v;
        if (first_[column] == first_[column + 1]) continue;
        const auto begin = along_.begin() + first_[column], end = along_.begin() + first_[column + 1];
        const auto from = std::lower_bound(begin, end, box.lower.z);
        const auto to = std::upper_bound(from, end, box.upper.z);
        if (from != to)
          f(static_cast<std::size_t>(from - along_.begin()), static_cast<std::size_t>(to - along_.begin()));
      }
  }
  /// Point numbers, column by column, each column from its lowest to its highest point.
  const std::vector<std::uint32_t>& order() const { return order_; }

 private:
  int cell(double x, double lower, int n) const {
    return static_cast<int>(std::clamp(std::floor((x - lower) / side_), 0.0, n - 1.0));
  }

  Axis axis_;
  double side_;
  Vec3 lower_{0};
  int nu_ = 0, nv_ = 0;
  std::vector<std::uint32_t> first_, order_;
  std::vector<double> along_;  // w of each point in `order_`
};

}  // namespace riffler::dexel
