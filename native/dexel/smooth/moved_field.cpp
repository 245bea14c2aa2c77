#include "dexel/smooth/moved_field.hpp"

#include <limits>

namespace riffler::dexel {

namespace {

/// Range of a point's plane, in pitches. Every place that the moving surface passed, no farther from a moved point than
/// rays are apart, has points within this distance.
constexpr double kFieldReach = 2;
/// Maximum distance of a surface point from the ends on its rays, in pitches: 0.71 if the surface lies along two axes.
constexpr double kWidestGap = 1.2;
/// Maximum deviation of the surface from a point's plane within that gap, in pitches, for a radius of curvature of two.
constexpr double kBend = 0.36;
/// Value at a place without points nearby.
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// Sorts intervals and joins those that touch.
void join(std::vector<Interval>& intervals) {
  std::sort(intervals.begin(), intervals.end(), [](const Interval& a, const Interval& b) { return a.near < b.near; });
  std::size_t n = 0;
  for (const Interval& i : intervals) {
    if (n > 0 && i.near <= intervals[n - 1].far)
      intervals[n - 1].far = std::max(intervals[n - 1].far, i.far);
    else
      intervals[n++] = i;
  }
  intervals.resize(n);
}

/// Weighted sums over points, relative to a place. The height is the average of two estimates: the mean of the points'
/// planes, and the plane through their mean. On a sphere their errors are equal and opposite.
struct Planes {
  double heights = 0;
  Vec3 mean{0}, normals{0};

  void add(double weight, const Vec3& r, const Vec3& normal) {
    heights += weight * glm::dot(normal, r), mean += weight * r, normals += weight * normal;
  }
  FieldValue value(double weights) const {
    const double length = glm::length(normals);
    const Vec3 direction = length > 1e-6 * weights ? normals / length : Vec3(0, 0, 1);
    return {0.5 * (heights + glm::dot(direction, mean)) / weights, direction};
  }
};

/// Estimate from the points of one sheet of the surface at a place whose old state is `inside` or not.
struct Sheet {
  double weights = 0;
  Planes before, after;

  struct Opinion {
    bool right;  // whether it agrees with the old state
    FieldValue now;
  };
  Opinion opinion(bool inside) const {
    const FieldValue was = before.value(weights), is = after.value(weights);
    return {(was.value < 0) == inside, {(inside ? -1 : 1) * std::abs(was.value) + (is.value - was.value), is.normal}};
  }
};

}  // namespace

MovedField::MovedField(const std::vector<MovedPoint>& points, const Columns& columns, double pitch)
    : points_(points), columns_(columns), pitch_(pitch), reach_(kFieldReach * pitch) {
  for (const MovedPoint& p : points) farthest_ = std::max(farthest_, p.way);
}

std::span<const Interval> MovedField::look_along(double u, double v) {
  find_changes(u, v);
  if (!changes_.empty()) gather(u, v);
  return changes_;
}

void MovedField::find_changes(double u, double v) {
  changes_.clear();
  const Axis axis = columns_.axis();
  const double most = kWidestGap * pitch_ + farthest_;
  const Box3 all{{u - most, v - most, -kNowhere}, {u + most, v + most, kNowhere}};
  columns_.for_each_run(all, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const MovedPoint& p = points_[columns_.order()[k]];
      if (!p.moved()) continue;
      const Interval change =
          change_around(to_local(axis, p.after) - Vec3(u, v, 0), to_local(axis, p.normal_after), p.way);
      if (change.near < change.far) changes_.push_back(change);
    }
  });
  join(changes_);
}

/// The interval of the ray through (0, 0, w) that the surface around a point at q swept: within the gap to the next
/// points, and as far from their plane as they moved, with a margin for the surface's curvature and rotation.
Interval MovedField::change_around(const Vec3& q, const Vec3& normal, double way) const {
  const double radius = kWidestGap * pitch_ + way, rest = radius * radius - q.x * q.x - q.y * q.y;
  if (rest <= 0) return {};
  const double half = std::sqrt(rest), thick = kBend * pitch_ + 3 * way;
  const double at_q = -normal.x * q.x - normal.y * q.y;  // height over the plane at the ray
  if (std::abs(normal.z) * half + std::abs(at_q) <= thick) return {q.z - half, q.z + half};
  if (std::abs(at_q) - std::abs(normal.z) * half >= thick) return {};
  const double a = (-thick - at_q) / normal.z, b = (thick - at_q) / normal.z;
  return Interval{q.z - half, q.z + half}.cut({q.z + std::min(a, b), q.z + std::max(a, b)});
}

void MovedField::gather(double u, double v) {
  const Axis axis = columns_.axis();
  const double most = reach_;
  const Box3 box{{u - most, v - most, changes_.front().near - most}, {u + most, v + most, changes_.back().far + most}};
  const auto off = [&](const Vec3& p) {
    const Vec3 q = to_local(axis, p);
    return (q.x - u) * (q.x - u) + (q.y - v) * (q.y - v);
  };
  order_.clear(), near_.clear(), off_.clear(), along_.clear();
  columns_.for_each_run(box, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k)
      if (off(points_[columns_.order()[k]].after) < reach_ * reach_) order_.push_back(columns_.order()[k]);
  });
  const auto along = [&](std::uint32_t k) { return to_local(axis, points_[k].after).z; };
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return along(a) != along(b) ? along(a) < along(b) : a < b; });
  const Vec3 ray(u, v, 0);
  for (const std::uint32_t k : order_) {
    const MovedPoint& p = points_[k];
    near_.push_back({to_local(axis, p.before) - ray, to_local(axis, p.after) - ray, to_local(axis, p.normal_before),
                     to_local(axis, p.normal_after)});
    off_.push_back(off(p.after)), along_.push_back(along(k));
  }
  square_.resize(near_.size());
}

FieldValue MovedField::operator()(double w, bool inside) {
  const auto begin = along_.begin(), end = along_.end();
  const auto from = std::lower_bound(begin, end, w - reach_), to = std::upper_bound(from, end, w + reach_);
  const auto first = static_cast<std::size_t>(from - begin), last = static_cast<std::size_t>(to - begin);
  const double reach_square = reach_ * reach_, inverse = 1 / reach_square, tiny = 1e-12 * pitch_ * pitch_;
  for (std::size_t k = first; k < last; ++k) square_[k] = off_[k] + (w - along_[k]) * (w - along_[k]);
  const auto at = [&](std::size_t k) { return square_.begin() + static_cast<std::ptrdiff_t>(k); };
  const auto nearest = static_cast<std::size_t>(std::min_element(at(first), at(last)) - at(0));
  if (nearest == last || square_[nearest] >= reach_square) return {inside ? -reach_ : reach_, {0, 0, 1}};

  const Vec3 reference = near_[nearest].normal_after;
  Sheet own, other;
  for (std::size_t k = first; k < last; ++k) {
    const double rest = 1 - square_[k] * inverse;
    if (rest <= 0) continue;
    const Near& p = near_[k];
    const double same = same_sheet(glm::dot(p.normal_after, reference));
    Sheet& sheet = same < 0.5 ? other : own;
    const double weight = rest * rest * rest / (square_[k] + tiny) * (same < 0.5 ? 1 - same : same);
    sheet.weights += weight;
    sheet.before.add(weight, Vec3(0, 0, w) - p.before, p.normal_before);
    sheet.after.add(weight, Vec3(0, 0, w) - p.after, p.normal_after);
  }
  const Sheet::Opinion mine = own.opinion(inside);
  if (!(other.weights > 0)) return mine.now;
  const Sheet::Opinion theirs = other.opinion(inside);
  if (!theirs.right) return mine.now;
  // Each of two sheets, the sides of a wall or gap, may have passed here.
  return !mine.right || (theirs.now.value > mine.now.value) == inside ? theirs.now : mine.now;
}

}  // namespace riffler::dexel
