#include "sweep/footprint.hpp"

#include <algorithm>
#include <cmath>

#include "geom/hypot.hpp"

namespace riffler::sweep {

Footprint::Footprint(std::span<const tool::Piece> pieces, std::initializer_list<Pose> poses, double slack) {
  for (const tool::Piece& piece : pieces) {
    Hull& hull = hulls_[count_++];
    const double radius = max_radius(piece);
    hull.thickness = radius + slack;
    // For a complete ball only the centre matters.
    const bool ball = whole_ball(piece);
    for (const Pose& pose : poses) {
      const double reach = ball ? hull.thickness : radius * geom::hypot(pose.axis.x, pose.axis.y) + slack;
      const auto add = [&](double z) {
        const Vec3 p = pose.tip + z * pose.axis;
        add_corner(hull, {p.x, p.y});
        rows_.include(p.x - hull.thickness), rows_.include(p.x + hull.thickness);
        columns_.include(p.y - hull.thickness), columns_.include(p.y + hull.thickness);
        height_.include(p.z - reach), height_.include(p.z + reach);
      };
      if (ball)
        add(std::get<tool::Round>(piece).zc);
      else
        add(bottom(piece)), add(top(piece));
    }
    // If the axis is parallel to the rays, the flank covers the same disc as the ball below it.
    const Hull* below = count_ > 1 ? &hulls_[count_ - 2] : nullptr;
    if (below && below->thickness == hull.thickness && below->corners == hull.corners &&
        std::equal(hull.corner, hull.corner + hull.corners, below->corner))
      hull = {}, --count_;
    else
      add_sides(hull);
  }
}

Footprint::Footprint(std::span<const Vec3> points, double slack) : slack_(slack) {
  thread_local base::BlockVector<Vec2> sorted;
  sorted.clear();
  for (const Vec3& p : points) {
    rows_.include(p.x), columns_.include(p.y), height_.include(p.z);
    sorted.push_back({p.x, p.y});
  }
  rows_ = {rows_.near - slack, rows_.far + slack}, columns_ = {columns_.near - slack, columns_.far + slack};
  height_ = {height_.near - slack, height_.far + slack};
  std::sort(sorted.begin(), sorted.end(),
            [](const Vec2& a, const Vec2& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  add_chain(sorted, 1);
  below_ = polygon_.size();
  add_chain(sorted, -1);
}

/// The hull's sides below (1) or above (-1) the points, which ascend along u. Sides at constant u are left out.
void Footprint::add_chain(std::span<const Vec2> sorted, double side) {
  thread_local base::BlockVector<Vec2> chain;
  chain.clear();
  for (const Vec2& p : sorted) {
    if (!chain.empty() && chain.back().x == p.x) {
      if (side * (p.y - chain.back().y) >= 0) continue;
      chain.pop_back();
    }
    while (chain.size() > 1) {
      const Vec2 a = chain[chain.size() - 2], b = chain.back();
      if (side * ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x)) > 0) break;
      chain.pop_back();
    }
    chain.push_back(p);
  }
  if (chain.size() == 1) polygon_.push_back({chain[0].x, chain[0].x, chain[0].x, chain[0].y, 0});
  for (std::size_t k = 0; k + 1 < chain.size(); ++k) {
    const Vec2 a = chain[k], b = chain[k + 1];
    polygon_.push_back({a.x, b.x, a.x, a.y, (b.y - a.y) / (b.x - a.x)});
  }
}

/// The rows of the hull of points. Over `slack` along u the range is that of the nearest row inside.
void Footprint::polygon_rows(const double* u, int n, Rows& out) const {
  for (std::size_t k = 0; k < polygon_.size(); ++k) {
    const Side& s = polygon_[k];
    for (int i = 0; i < n; ++i) {
      // within [u - slack, u + slack], a side is lowest or highest at one of the two ends
      if (u[i] + slack_ < s.from || u[i] - slack_ > s.to) continue;
      const double a = std::clamp(u[i] - slack_, s.from, s.to), b = std::clamp(u[i] + slack_, s.from, s.to);
      const double va = s.y + s.slope * (a - s.x), vb = s.y + s.slope * (b - s.x);
      if (k < below_)
        out.near[i] = std::min(out.near[i], std::min(va, vb) - slack_);
      else
        out.far[i] = std::max(out.far[i], std::max(va, vb) + slack_);
    }
  }
}

void Footprint::add_corner(Hull& hull, const Vec2& p) {
  for (int k = 0; k < hull.corners; ++k)
    if (hull.corner[k] == p) return;  // the other end of an axis parallel to the rays
  hull.corner[hull.corners++] = p;
}

/// The hull's edges are among the connections of its corners. A connection with another corner beyond it is inside the
/// hull.
void Footprint::add_sides(Hull& hull) {
  for (int i = 0; i < hull.corners; ++i)
    for (int k = i + 1; k < hull.corners; ++k) {
      const Vec2 a = hull.corner[i], b = hull.corner[k], edge = b - a;
      // A side at constant u ends where a corner's disc ends too.
      if (edge.x == 0) continue;
      const Vec2 across = Vec2(-edge.y, edge.x) * (hull.thickness / glm::length(edge));
      const double slope = edge.y / edge.x, square = hull.thickness * hull.thickness;
      for (const double side : {1.0, -1.0}) {
        double beyond = 0;
        for (int m = 0; m < hull.corners; ++m) beyond = std::max(beyond, side * glm::dot(hull.corner[m] - a, across));
        if (beyond > 1e-9 * square) continue;
        const Vec2 from = b + side * across;
        const double other = from.x - edge.x;
        hull.side[hull.sides++] = {std::min(from.x, other), std::max(from.x, other), from.x, from.y, slope};
      }
    }
}

// Loops without branches or calls, which compilers vectorise.
void Footprint::rows(const double* u, int n, Rows& out) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::fill_n(out.near, n, kInfinity), std::fill_n(out.far, n, -kInfinity);
  if (!polygon_.empty()) return polygon_rows(u, n, out);
  double* const near = out.near;
  double* const far = out.far;
  const auto include = [=](int k, double low, double high) {
    near[k] = low < near[k] ? low : near[k];
    far[k] = high > far[k] ? high : far[k];
  };
  for (std::size_t i = 0; i < count_; ++i) {
    const Hull& hull = hulls_[i];
    for (int c = 0; c < hull.corners; ++c) {
      const Vec2 p = hull.corner[c];
      const double square = hull.thickness * hull.thickness;
      for (int k = 0; k < n; ++k) {
        const double half = square - (u[k] - p.x) * (u[k] - p.x), root = std::sqrt(std::max(half, 0.0));
        include(k, half >= 0 ? p.y - root : kInfinity, half >= 0 ? p.y + root : -kInfinity);
      }
    }
    for (int c = 0; c < hull.sides; ++c) {
      const Side s = hull.side[c];
      for (int k = 0; k < n; ++k) {
        const double v = s.y + s.slope * (u[k] - s.x);
        const double low = u[k] >= s.from ? v : kInfinity, high = u[k] >= s.from ? v : -kInfinity;
        include(k, u[k] <= s.to ? low : kInfinity, u[k] <= s.to ? high : -kInfinity);
      }
    }
  }
}

bool Footprint::overlaps(const Box3& box) const {
  return rows_.near <= box.upper.x && rows_.far >= box.lower.x && columns_.near <= box.upper.y &&
         columns_.far >= box.lower.y && height_.near <= box.upper.z && height_.far >= box.lower.z;
}

}  // namespace riffler::sweep
