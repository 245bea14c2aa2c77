// All arcs of less than half a turn over one chord that bulge to one side form one family: x, the height of the apex
// over half the chord, runs from 0 to 1, and two of them never meet between the ends. The arcs that pass a point within
// a given distance are therefore those with x in an interval, in closed form, and the arcs near all points are the
// intersection of these intervals.
#include "nc/write/arc_through.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"

namespace riffler::nc {

namespace {

Vec2 flat(const Vec3& local) {
  return {local.x, local.y};
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

struct Range {
  double low, high;

  /// Keeps the x with a x² + b x + c ≥ 0; of two intervals the lower.
  void keep(double a, double b, double c) {
    const double square = b * b - 4 * a * c;
    if (square < 0) {
      if (c < 0) high = -1;
      return;
    }
    // Both roots without cancellation (Press et al., Numerical Recipes, 3rd ed., p. 227).
    const double q = -(b + std::copysign(std::sqrt(square), b)) / 2;
    if (q == 0) {  // b = 0, and a or c is
      if (a < 0 || c < 0) high = -1;
      return;
    }
    double one = c / q;
    if (a == 0) {  // b x + c
      if (b > 0)
        low = std::max(low, one);
      else
        high = std::min(high, one);
      return;
    }
    double two = q / a;
    if (one > two) std::swap(one, two);
    if (a < 0)
      low = std::max(low, one), high = std::min(high, two);
    else if (low <= one)
      high = std::min(high, one);
    else
      low = std::max(low, two);
  }
  bool empty() const { return !(low <= high); }
};

/// The chord of a row of points, seen along the normal.
class Chord {
 public:
  Chord(std::span<const Vec3> points, Axis normal) : points_(points), normal_(normal) {
    first_ = to_local(normal, points.front()), last_ = to_local(normal, points.back());
    const Vec2 chord = flat(last_) - flat(first_);
    half_ = glm::length(chord) / 2;
    middle_ = flat(first_) + chord / 2.0;
    along_ = half_ > 0 ? chord / (2 * half_) : Vec2(0);
  }

  /// Chooses the side of the bulge: that of the point furthest away.
  void choose_side(std::size_t& looked_at) {
    double most = 0;
    for (std::size_t k = stride(points_.size()); k + 1 < points_.size(); k += stride(points_.size())) {
      ++looked_at;
      const double off = cross(along_, flat(to_local(normal_, points_[k])) - middle_);
      if (std::abs(off) > std::abs(most)) most = off;
    }
    left_ = most > 0;
  }
  void take_side(const PlaneArc& arc) { left_ = arc.sweep < 0; }

  /// The x whose radius is within its limits and whose sweep 4 atan x is not too large.
  Range limits() const {
    const auto of_radius = [&](double r) { return half_ / (r + std::sqrt((r - half_) * (r + half_))); };
    if (!(half_ > kSamePoint && half_ < kMaxArcRadius)) return {0, -1};
    const double most = base::tan(kMaxArcSweep / 4);
    return {of_radius(kMaxArcRadius), half_ < kMinArcRadius ? std::min(most, of_radius(kMinArcRadius)) : most};
  }

  /// The x within `range` of circles within `tolerance` of all points.
  ///
  /// With half the chord as unit, for the point (a, b) above the chord's middle and a circle with centre height (x² −
  /// 1) / 2x and radius (x² + 1) / 2x, the conditions distance − radius ≤ t and ≥ −t, squared and multiplied by x, are
  /// quadratic in x.
  Range near(double tolerance, Range range, std::size_t& looked_at) const {
    const double t = tolerance / half_;
    const auto keep = [&](std::size_t k) {
      ++looked_at;
      const Vec2 p = (flat(to_local(normal_, points_[k])) - middle_) / half_;
      const double a = glm::dot(p, along_), b = left_ ? cross(along_, p) : -cross(along_, p);
      // All the circles pass within t of a point that is within t of an end.
      const double end = 1 - std::abs(a);
      if (end * end + b * b <= t * t) return;
      const double square = (a - 1) * (a + 1) + (b - t) * (b + t);
      range.keep(b + t, -square, t - b);
      range.keep(t - b, square, b + t);
    };
    for (std::size_t step = stride(points_.size());; step = 1) {
      for (std::size_t k = step; k + 1 < points_.size() && !range.empty(); k += step) keep(k);
      if (step == 1 || range.empty()) return range;
    }
  }

  PlaneArc arc(double x) const {
    const Vec2 left(-along_.y, along_.x);
    const double height = half_ * (x - 1) * (x + 1) / (2 * x), sweep = 4 * base::atan(x);
    return {normal_, middle_ + (left_ ? height : -height) * left, left_ ? -sweep : sweep};
  }

 private:
  std::span<const Vec3> points_;
  Axis normal_;
  Vec3 first_, last_;
  Vec2 middle_, along_;
  double half_ = 0;
  bool left_ = false;
};

/// One move of the polyline next to the arc, relative to its centre: `from` and `to` in its plane, turned so that the
/// arc is counter-clockwise.
struct Beside {
  Vec2 from, to;
  double height;  ///< mm: height of `from` above the arc
  double climb;   ///< mm: rise of the move along the normal
  double rise;    ///< mm/rad: rise of the arc
};

/// The largest deficit of the radius, and error of the height, inside the move; at its ends they are known.
///
/// Inside, the radius is smallest at the foot of the perpendicular from the centre, at distance d. With y from there
/// along the move, the angle is atan(y / d), so the height above the arc is extreme where climb / length = rise d / (d²
/// + y²).
void look_between(const Beside& m, double radius, double& missing, double& wrong) {
  const Vec2 way = m.to - m.from;
  const double length = glm::length(way);
  if (length < kSamePoint) return;
  const double d = cross(m.from, way) / length, begin = glm::dot(m.from, way) / length, end = begin + length;
  if (begin < 0 && end > 0) missing = std::max(missing, radius - d);
  if (m.climb == 0 || m.rise == 0) return;
  const double square = m.rise * d * length / m.climb - d * d;
  if (!(square > 0)) return;
  for (const double y : {-std::sqrt(square), std::sqrt(square)})
    if (y > begin && y < end)
      wrong = std::max(wrong, std::abs(m.height + m.climb * (y - begin) / length -
                                       m.rise * (base::atan2(y, d) - base::atan2(begin, d))));
}

/// Whether polyline and arc are within the tolerance of each other at every angle, and the angle never decreases.
bool fits(std::span<const Vec3> points, const PlaneArc& arc, double tolerance, std::size_t& looked_at) {
  const double sense = arc.sweep > 0 ? 1 : -1, sweep = std::abs(arc.sweep);
  const Vec3 first = to_local(arc.normal, points.front());
  const Vec2 start = flat(first) - arc.centre;
  const double radius = glm::length(start), slack = kSamePoint / radius;
  const double rise = (to_local(arc.normal, points.back()).z - first.z) / sweep;
  // Frame of the arc: x towards its start, y ahead.
  const Vec2 x = start / radius, y = sense * Vec2(-x.y, x.x);

  Beside move{{radius, 0}, {0, 0}, 0, 0, rise};
  double furthest = 0, off = 0, before = first.z;
  for (std::size_t k = 1; k < points.size(); ++k) {
    ++looked_at;
    const Vec3 p = to_local(arc.normal, points[k]);
    const Vec2 from_centre = flat(p) - arc.centre;
    move.to = {glm::dot(from_centre, x), glm::dot(from_centre, y)};
    const double angle = base::atan2(move.to.y, move.to.x);
    if (!(angle >= furthest - slack && angle <= sweep + slack)) return false;
    move.climb = p.z - before;
    const double height = p.z - first.z - rise * angle, off_here = std::abs(glm::length(move.to) - radius);
    double missing = std::max(off, off_here), wrong = std::max(std::abs(move.height), std::abs(height));
    look_between(move, radius, missing, wrong);
    if (missing * missing + wrong * wrong > tolerance * tolerance) return false;
    move.from = move.to, move.height = height;
    before = p.z, off = off_here, furthest = std::max(furthest, angle);
  }
  return true;
}

}  // namespace

std::optional<PlaneArc> arc_within(std::span<const Vec3> points, Axis normal, double tolerance,
                                   std::size_t& looked_at) {
  Chord chord(points, normal);
  Range range = chord.limits();
  if (range.empty()) return std::nullopt;
  chord.choose_side(looked_at);
  range = chord.near(tolerance, range, looked_at);
  if (range.empty()) return std::nullopt;
  // Chords lie inside their arc: the flattest arc that the points allow is the first that the chords allow.
  const double inset = 1e-6 * (range.high - range.low);
  for (const double x : {(range.low + range.high) / 2, range.low + inset})
    if (const PlaneArc arc = chord.arc(x); fits(points, arc, tolerance, looked_at)) return arc;
  return std::nullopt;
}

PlaneArc nearest_arc(std::span<const Vec3> points, const PlaneArc& found, double tolerance, std::size_t& looked_at) {
  Chord chord(points, found.normal);
  chord.take_side(found);
  const Range limits = chord.limits();
  // The smallest tolerance that leaves a circle: below it, none is near all points.
  double low = 0, high = tolerance;
  Range best{0, -1};
  for (int step = 0; step < 24; ++step) {
    const double middle = (low + high) / 2;
    const Range range = chord.near(middle, limits, looked_at);
    if (range.empty())
      low = middle;
    else
      high = middle, best = range;
  }
  if (best.empty()) return found;
  const PlaneArc arc = chord.arc((best.low + best.high) / 2);
  return fits(points, arc, tolerance, looked_at) ? arc : found;
}

}  // namespace riffler::nc
