// A ray that looks for triangles and boxes.
//
// No ray falls through between triangles that share an edge, or out of a box that holds what it hits. After Woop,
// Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: points are sheared until the ray is the
// third axis, by operations that give a vertex the same place in each of its triangles; there only signs decide, and
// these are exact. So the sheared surface is closed, and the signs are those of one closed surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "riffler/geom/vec.hpp"

namespace riffler::marching {

class Sight {
 public:
  /// `direction`: of any length but 0. `far`: no coordinate of what it looks for is greater. std::invalid_argument
  /// where one is not finite, or the direction is zero.
  Sight(const Vec3& origin, const Vec3& direction, double far);

  /// Unit.
  const Vec3& direction() const { return direction_; }
  /// The axis that the ray runs along most.
  int axis() const { return k_; }
  Vec3 at(double distance) const { return origin_ + distance * direction_; }

  /// x, y: how far beside the ray, along two axes of the frame; z: how far along it, mm.
  Vec3 sheared(const Vec3& point) const {
    const Vec3 p = point - origin_;
    return {p[i_] - slope_i_ * p[k_], p[j_] - slope_j_ * p[k_], p[k_] * along_};
  }

  struct Range {
    double enter, leave;
    bool empty() const { return !(enter <= leave); }
  };
  /// Where the ray is in a box, mm from its origin: never less than that.
  template <class Point>
  Range through(const Point& lower, const Point& upper) const {
    Range out{0, std::numeric_limits<double>::infinity()};
    for (int a = 0; a < 3; ++a) {
      const double s = (lower[a] - above_[a]) * inverse_[a], t = (upper[a] - below_[a]) * inverse_[a];
      out.enter = std::max(out.enter, std::min(s, t)), out.leave = std::min(out.leave, std::max(s, t));
    }
    return out;
  }

  /// The least and the greatest coordinate of a range's points, if it is finite.
  std::pair<double, double> between(int axis, const Range& range) const {
    const double from = at(range.enter)[axis], to = at(range.leave)[axis];
    return {std::min(from, to) - margin_, std::max(from, to) + margin_};
  }

 private:
  Vec3 origin_, direction_;
  Vec3 inverse_;        // of the direction, finite
  double margin_;       // for roundings
  Vec3 below_, above_;  // the origin, less and more that
  int i_, j_, k_;
  double slope_i_, slope_j_, along_;
};

/// Twice the area of the triangle (0, a, b), positive where it runs counter-clockwise. The sign is exact: a difference
/// of rounded products is 0 or has the sign of the true one, and where it is 0 what was rounded away decides.
inline double twice_area(const Vec3& a, const Vec3& b) {
  const double p = a.x * b.y, q = b.x * a.y;
  if (p != q) [[likely]]
    return p - q;
  return std::fma(a.x, b.y, -p) - std::fma(b.x, a.y, -q);
}

}  // namespace riffler::marching
