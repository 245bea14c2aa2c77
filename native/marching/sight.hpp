// A ray for intersecting triangles and boxes.
//
// Watertight: no ray passes between triangles that share an edge, or misses a box that contains its hit. After Woop,
// Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013: points are sheared so that the ray becomes
// the third axis, by operations that give a vertex the same place in each of its triangles. After that only signs
// decide, and they are exact. So the sheared surface is closed, and the signs are those of one closed surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "riffler/geom/vec.hpp"

namespace riffler::marching {

class Sight {
 public:
  /// `direction`: any length but 0. `far`: upper limit of all coordinates that the ray is tested against. Throws
  /// std::invalid_argument if an argument is not finite or the direction is zero.
  Sight(const Vec3& origin, const Vec3& direction, double far);

  /// Unit length.
  const Vec3& direction() const { return direction_; }
  /// The axis closest to the ray's direction.
  int axis() const { return k_; }
  Vec3 at(double distance) const { return origin_ + distance * direction_; }

  /// x, y: offset from the ray along two axes of the frame; z: distance along the ray, mm.
  Vec3 sheared(const Vec3& point) const {
    const Vec3 p = point - origin_;
    return {p[i_] - slope_i_ * p[k_], p[j_] - slope_j_ * p[k_], p[k_] * along_};
  }

  struct Range {
    double enter, leave;
    bool empty() const { return !(enter <= leave); }
  };
  /// The range of the ray inside a box, mm from its origin: conservative, never too small.
  template <class Point>
  Range through(const Point& lower, const Point& upper) const {
    Range out{0, std::numeric_limits<double>::infinity()};
    for (int a = 0; a < 3; ++a) {
      const double s = (lower[a] - above_[a]) * inverse_[a], t = (upper[a] - below_[a]) * inverse_[a];
      out.enter = std::max(out.enter, std::min(s, t)), out.leave = std::min(out.leave, std::max(s, t));
    }
    return out;
  }

  /// Lowest and highest coordinate of the range's points, for a finite range.
  std::pair<double, double> between(int axis, const Range& range) const {
    const double from = at(range.enter)[axis], to = at(range.leave)[axis];
    return {std::min(from, to) - margin_, std::max(from, to) + margin_};
  }

 private:
  Vec3 origin_, direction_;
  Vec3 inverse_;        // inverse of the direction, finite
  double margin_;       // for rounding
  Vec3 below_, above_;  // the origin minus and plus the margin
  int i_, j_, k_;
  double slope_i_, slope_j_, along_;
};

/// Twice the area of the triangle (0, a, b), positive if counter-clockwise. The sign is exact: the difference of the
/// rounded products is 0 or has the true sign; if it is 0, the rounding errors decide.
inline double twice_area(const Vec3& a, const Vec3& b) {
  const double p = a.x * b.y, q = b.x * a.y;
  if (p != q) [[likely]]
    return p - q;
  return std::fma(a.x, b.y, -p) - std::fma(b.x, a.y, -q);
}

}  // namespace riffler::marching
