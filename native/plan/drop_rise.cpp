// The drop surface above a straight move: exact searches over a part's triangles, not samples.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geom/hypot.hpp"
#include "plan/drop_core.hpp"
#include "riffler/geom/interval.hpp"

namespace riffler::plan {

namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();
constexpr int kMaxSamples = 48;
constexpr double kFine = 1e-7;  // mm: a hundredth of the smallest sensible tolerance

/// The shares of the line from `from` along `way` within `rim` of the triangle's outline, seen from above: their hull.
std::optional<Vec2> shares_in_reach(const std::array<Vec2, 3>& corners, const Vec2& from, const Vec2& way, double rim) {
  double low = std::numeric_limits<double>::infinity(), high = kNever;
  const double length2 = glm::dot(way, way);
  const auto add = [&](double a, double b) { low = std::min(low, a), high = std::max(high, b); };
  for (int k = 0; k < 3; ++k) {
    const Vec2 off = corners[k] - from;
    const double middle = glm::dot(off, way) / length2;
    const double aside2 = glm::dot(off, off) - middle * middle * length2;
    if (aside2 <= rim * rim) {
      const double half = std::sqrt(std::max(0.0, rim * rim - aside2) / length2);
      add(middle - half, middle + half);
    }
    // The band along the edge: two pairs of parallel lines.
    const Vec2 edge = corners[(k + 1) % 3] - corners[k];
    const double size = glm::length(edge);
    if (!(size > 0)) continue;
    const Vec2 along = edge / size, across(-along.y, along.x);
    double first = kNever, last = -kNever;
    const auto clip = [&](double at, double rate, double least, double most) {
      if (rate == 0) {
        if (at < least || at > most) last = kNever;
        return;
      }
      const double a = (least - at) / rate, b = (most - at) / rate;
      first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
    };
    clip(-glm::dot(off, along), glm::dot(way, along), 0, size);
    clip(-glm::dot(off, across), glm::dot(way, across), -rim, rim);
    if (first <= last) add(first, last);
  }
  low = std::max(low, 0.0), high = std::min(high, 1.0);
  if (!(low <= high)) return {};
  return Vec2(low, high);
}

/// Largest value of a concave function on [low, high], if it is more than `best`: samples where the secants of the
/// others leave the most room. `f` may be −∞ at the ends of the interval.
class ConcavePeak {
 public:
  template <class F>
  void search(const F& f, double low, double high, double& best, double& at) {
    count_ = 0;
    const double inset = 1e-9 * (high - low);
    const auto sample = [&](double s) {
      const double value = f(s);
      if (value > best) best = value, at = s;
      if (value > kNever) insert(s, value);
    };
    sample(low + inset), sample(0.5 * (low + high));
    if (high > low) sample(high - inset);
    while (count_ >= 2 && count_ < kMaxSamples) {
      double room = best + kFine, where = 0;
      for (int i = 0; i + 1 < count_; ++i)
        if (const Vec2 bound = peak_between(i); bound.y > room) room = bound.y, where = bound.x;
      if (!(room > best + kFine)) break;
      const int before = count_;
      sample(where);
      if (count_ == before) break;
    }
  }

 private:
  void insert(double s, double value) {
    int k = count_;
    while (k > 0 && s_[k - 1] > s) --k;
    if ((k > 0 && s_[k - 1] == s) || (k < count_ && s_[k] == s)) return;
    for (int i = count_; i > k; --i) s_[i] = s_[i - 1], f_[i] = f_[i - 1];
    s_[k] = s, f_[k] = value, ++count_;
  }
  double secant(int i, double s) const { return f_[i] + (f_[i + 1] - f_[i]) / (s_[i + 1] - s_[i]) * (s - s_[i]); }

  /// Upper bound between samples i and i + 1, as (place, value).
  Vec2 peak_between(int i) const {
    const double a = s_[i], b = s_[i + 1], middle = 0.5 * (a + b);
    const bool left = i > 0, right = i + 2 < count_;
    if (!left && !right) return {middle, std::numeric_limits<double>::infinity()};
    if (!left || !right) {
      const double end = right ? secant(i + 1, a) : secant(i - 1, b);
      return {middle, std::max({end, f_[i], f_[i + 1]})};
    }
    const double at_a = secant(i + 1, a) - f_[i], at_b = secant(i - 1, b) - f_[i + 1];  // both ≥ 0 but for rounding
    if (!(at_a > 0) || !(at_b > 0)) return {middle, std::max(f_[i], f_[i + 1])};
    // The lines f_i + (f_{i+1} + at_b − f_i) x and f_i + at_a + (f_{i+1} − f_i − at_a) x cross at x.
    const double x = at_a / (at_a + at_b);
    return {a + std::clamp(x, 0.05, 0.95) * (b - a), f_[i] + (f_[i + 1] + at_b - f_[i]) * x};
  }

  int count_ = 0;
  std::array<double, kMaxSamples + 1> s_, f_;
};

}  // namespace

/// One straight move, against boxes and triangles.
struct RiseSearch {
  const DropCutter::Core& tree;
  Vec3 from, way;
  double best, at = 0;
  Vec2 along{0}, across{0};  // unit vectors of the move, seen from above
  double length = 0, rim = 0;

  RiseSearch(const DropCutter::Core& core, const Vec3& a, const Vec3& b, double enough)
      : tree(core), from(a), way(b - a), best(enough), length(geom::hypot(way.x, way.y)) {
    along = Vec2(way.x, way.y) / length, across = Vec2(-along.y, along.x);
    for (const auto& side : tree.sides_) rim = std::max(rim, side.second.rim());
  }

  /// Upper bound of the rise over what lies in the box.
  double bound(const Box3& box) const {
    const Vec2 centre(0.5 * (box.lower.x + box.upper.x) - from.x, 0.5 * (box.lower.y + box.upper.y) - from.y);
    const Vec2 half(0.5 * (box.upper.x - box.lower.x), 0.5 * (box.upper.y - box.lower.y));
    const double u = glm::dot(centre, along), v = std::abs(glm::dot(centre, across));
    const double hu = half.x * std::abs(along.x) + half.y * std::abs(along.y),
                 hv = half.x * std::abs(across.x) + half.y * std::abs(across.y);
    const double x0 = std::min(from.x, from.x + way.x), x1 = std::max(from.x, from.x + way.x);
    const double y0 = std::min(from.y, from.y + way.y), y1 = std::max(from.y, from.y + way.y);
    const double gap = glm::length(
        Vec2(std::max({box.lower.x - x1, x0 - box.upper.x, 0.0}), std::max({box.lower.y - y1, y0 - box.upper.y, 0.0})));
    const double aside = std::max(v - hv, 0.0), ahead = std::max({u - hu - length, -u - hu, 0.0});
    const double rho = std::max(gap, std::sqrt(aside * aside + ahead * ahead));
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [part, lower] : tree.sides_)
      if (rho <= lower.rim()) least = std::min(least, lower.height(rho));
    const double first = std::clamp((u - hu - rim) / length, 0.0, 1.0),
                 last = std::clamp((u + hu + rim) / length, 0.0, 1.0);
    return box.upper.z - least - from.z - std::min(first * way.z, last * way.z);
  }

  void leaf(std::size_t place) {
    for (std::size_t t = tree.first(tree.levels_, place); t < tree.first(tree.levels_, place + 1); ++t) {
      const DropCutter::Core::Triangle& tri = tree.triangles_[t];
      Box3 box;
      box.add(tri.a), box.add(tri.b), box.add(tri.c);
      if (!(bound(box) > best)) continue;
      for (const auto& side : tree.sides_) meet(side.second, tri);
    }
  }

  /// The shares of the move where the triangle's plane stops the piece above `best`: elsewhere the triangle cannot.
  Vec2 shares_over_plane(const LowerSide& side, const DropCutter::Core::Triangle& tri) const {
    const Vec3 shift(from.x, from.y, 0);
    const auto plane = side.on_plane(tri.a - shift, tri.b - shift, tri.c - shift);
    if (!plane) return {0, 1};
    const double change = glm::dot(plane->slope, Vec2(way)) - way.z;
    const double start = plane->tip - from.z - best + kFine * (1 + std::abs(change)), end = start + change;
    if (start > 0 && end > 0) return {0, 1};
    if (!(start > 0) && !(end > 0)) return {1, 0};
    return change > 0 ? Vec2(-start / change, 1) : Vec2(0, -start / change);
  }

  void meet(const LowerSide& side, const DropCutter::Core::Triangle& tri) {
    const Vec2 room = shares_over_plane(side, tri);
    if (!(room.x <= room.y)) return;
    auto range = shares_in_reach({Vec2(tri.a), Vec2(tri.b), Vec2(tri.c)}, Vec2(from), Vec2(way), side.rim());
    if (!range) return;
    range = Vec2(std::max(range->x, room.x), std::min(range->y, room.y));
    if (!(range->x <= range->y)) return;
    const auto above = [&](double s) {
      const Vec3 shift(from.x + s * way.x, from.y + s * way.y, 0);
      LowerSide::Stop stop{kNever, Vec3(0), false};
      side.meet(tri.a - shift, tri.b - shift, tri.c - shift, stop);
      return stop.touches ? stop.tip - from.z - s * way.z : kNever;
    };
    ConcavePeak().search(above, range->x, range->y, best, at);
  }

  void descend(std::size_t node, std::size_t level, std::size_t place) {
    if (level == tree.levels_) return leaf(place);
    const double low = bound(tree.boxes_[2 * node + 1]), high = bound(tree.boxes_[2 * node + 2]);
    for (const bool second : {high > low, !(high > low)})
      if ((second ? high : low) > best) descend(2 * node + 1 + second, level + 1, 2 * place + second);
  }
};

DropCutter::Rise DropCutter::rise(const Vec3& from, const Vec3& to, double enough) const {
  const Vec3 a = from * core_->turn_, b = to * core_->turn_;
  if (a.x == b.x && a.y == b.y) {
    const Landing here = (*this)(from);
    return {here.touches ? std::max(enough, here.height - std::min(a.z, b.z)) : enough, a.z < b.z ? 0.0 : 1.0};
  }
  RiseSearch search(*core_, a, b, enough);
  if (search.bound(core_->boxes_[0]) > search.best) search.descend(0, 0, 0);
  return {search.best, search.at};
}

double DropCutter::height_on(const Landing& landing, const Vec3& p) const {
  const Vec3 local = p * core_->turn_, shift(local.x, local.y, 0);
  const Core::Triangle& tri = core_->triangles_[landing.position];
  LowerSide::Stop stop{kNever, Vec3(0), false};
  core_->sides_[landing.piece].second.meet(tri.a - shift, tri.b - shift, tri.c - shift, stop);
  return stop.tip;
}

}  // namespace riffler::plan
