#include "plan/outline/offset.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plan/contours.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr int kHalvings = 60, kDeepest = 14, kMoves = 24;

class Offset {
 public:
  Offset(const PlaceGrid& grid, const PlaceSet& in, const SetBorder& border, double distance, double tolerance)
      : grid_(grid),
        in_(in),
        border_(border),
        least_(distance + 0.25 * tolerance),
        aim_(distance + 0.6 * tolerance),
        tolerance_(tolerance),
        far_(2 * distance + 4 * grid.spacing),
        field_(grid.size()) {
    base::parallel_for(grid.size(), 256, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) field_[k] = in_[k] ? 0 : distance_of(grid_.place(k));
    });
  }

  OffsetLoops run() const {
    OffsetLoops out;
    const auto crossing = [&](std::size_t less, std::size_t more) { return crossing_of(less, more); };
    for (const Curve& curve : contours(grid_, field_, aim_, crossing))
      if (curve.closed && curve.points.size() > 2) out.loops.push_back(refined(curve.points));
    out.narrow = narrow_places();
    return out;
  }

 private:
  double distance_of(const Vec2& p) const {
    Vec2 q;
    return border_.nearest(p, far_, q) ? glm::length(q - p) : far_;
  }
  Vec2 crossing_of(std::size_t less, std::size_t more) const {
    Vec2 low = grid_.place(less), high = grid_.place(more);
    for (int k = 0; k < kHalvings && low != high; ++k) {
      const Vec2 middle = 0.5 * (low + high);
      if (middle == low || middle == high) break;
      // A place deep inside the set may be far from every segment, but it is still inside the set.
      (distance_of(middle) < aim_ ? low : high) = middle;
    }
    return high;
  }
  /// Moves the point away from the nearest point of the border, or towards it, until it is at the intended distance.
  Vec2 onto(Vec2 p) const {
    for (int k = 0; k < kMoves; ++k) {
      Vec2 q;
      if (!border_.nearest(p, far_, q)) return p;
      const double d = glm::length(p - q);
      if (std::abs(d - aim_) < 0.01 * tolerance_ || !(d > 0)) return p;
      p = q + aim_ / d * (p - q);
    }
    return p;
  }
  void halve(const Vec2& a, const Vec2& b, int depth, std::vector<Vec2>& out) const {
    const Vec2 middle = 0.5 * (a + b), there = onto(middle);
    const bool close = border_.distance(a, b, far_) >= least_ && glm::length(there - middle) <= 0.25 * tolerance_;
    if (close || depth == kDeepest || glm::length(there - middle) > glm::length(b - a)) return;
    halve(a, there, depth + 1, out);
    out.push_back(there);
    halve(there, b, depth + 1, out);
  }
  std::vector<Vec2> refined(const std::vector<Vec2>& points) const {
    std::vector<Vec2> out;
    for (std::size_t k = 0; k < points.size(); ++k) {
      out.push_back(points[k]);
      halve(points[k], points[(k + 1) % points.size()], 0, out);
    }
    std::vector<Vec2> few = simplified({out, true}, 0.15 * tolerance_).points;
    for (std::size_t k = 0; k < few.size(); ++k)
      if (border_.distance(few[k], few[(k + 1) % few.size()], far_) < least_ - 0.25 * tolerance_) return out;
    return few;
  }
  /// A place near `p` whose distance from the border is a local maximum.
  Vec2 deepest_near(Vec2 p) const {
    for (double step = 0.5 * grid_.spacing; step > tolerance_; step *= 0.5)
      for (const Vec2 by : {Vec2(step, 0), Vec2(-step, 0), Vec2(0, step), Vec2(0, -step)})
        while (distance_of(p + by) > distance_of(p)) p += by;
    return p;
  }
  /// Connected areas outside of the set in which no place is far enough from the border.
  std::vector<NarrowPlace> narrow_places() const {
    std::vector<NarrowPlace> out;
    PlaceSet seen(grid_.size(), 0);
    std::vector<std::size_t> open;
    for (std::size_t first = 0; first < seen.size(); ++first) {
      if (seen[first] || in_[first]) continue;
      NarrowPlace here;
      std::size_t most = first, count = 0;
      seen[first] = 1, open = {first};
      while (!open.empty()) {
        const std::size_t k = open.back();
        open.pop_back();
        ++count;
        if (field_[k] > field_[most]) most = k;
        const auto n = static_cast<std::size_t>(grid_.columns);
        const std::size_t column = k % n, row = k / n;
        const auto visit = [&](bool there, std::size_t to) {
          if (!there) return;
          if (in_[to])
            here.length += grid_.spacing;
          else if (!seen[to])
            seen[to] = 1, open.push_back(to);
        };
        visit(column > 0, k - 1), visit(column + 1 < n, k + 1), visit(row > 0, k - n);
        visit(row + 1 < static_cast<std::size_t>(grid_.rows), k + n);
      }
      if (field_[most] >= aim_ || count < 3) continue;
      here.place = deepest_near(grid_.place(most)), here.width = 2 * distance_of(here.place);
      out.push_back(here);
    }
    return out;
  }

  const PlaceGrid& grid_;
  const PlaceSet& in_;
  const SetBorder& border_;
  double least_, aim_, tolerance_, far_;
  Field field_;
};

}  // namespace

OffsetLoops offset_loops(const PlaceGrid& grid, const PlaceSet& in, const SetBorder& border, double distance,
                         double tolerance) {
  return Offset(grid, in, border, distance, tolerance).run();
}

}  // namespace riffler::plan
