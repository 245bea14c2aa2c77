#include "plan/point_lift.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::plan {

namespace {

/// Adds the heights at which the circle of radius `r` around `centre` meets the column.
void add_circle(const Vec2& centre, double r, double rho, std::vector<double>& heights) {
  const double off = rho - centre.x, half = (r - off) * (r + off);
  if (half < 0) return;
  heights.push_back(centre.y - std::sqrt(half)), heights.push_back(centre.y + std::sqrt(half));
}

}  // namespace

void OffsetToolColumns::candidates(double rho, std::vector<double>& heights) const {
  for (const tool::OutlineEdge& e : outline_->edges()) {
    const double c = std::abs(c_);
    add_circle(e.from, c, rho, heights), add_circle(e.to, c, rho, heights);
    if (e.centre) {
      // Offsets of an arc. A negative radius is the far side of a hollow that has closed: no boundary.
      const double r = std::abs(e.bulge) + (e.bulge > 0 ? c_ : -c_);
      if (r >= 0) add_circle(*e.centre, r, rho, heights);
      continue;
    }
    const Vec2 way = e.to - e.from, normal = Vec2(way.y, -way.x) / glm::length(way), start = e.from + c_ * normal;
    if (way.x == 0) continue;  // vertical: in no column, or along a whole column between the circles of its corners
    heights.push_back(start.y + (rho - start.x) * (way.y / way.x));
  }
}

OffsetToolColumns::Column OffsetToolColumns::at(double rho, double z) const {
  if (!covers(rho, z)) return {};
  std::vector<double> heights;
  candidates(rho, heights);
  std::sort(heights.begin(), heights.end());
  // Every interval end is among the heights, so the column is entirely covered or free between two of them.
  const auto above = std::upper_bound(heights.begin(), heights.end(), z);
  Column out{true, z, z};
  const auto free_between = [&](double a, double b) { return !covers(rho, 0.5 * (a + b)); };
  for (auto at = above; at != heights.begin();) {
    out.low = *--at;
    const double next = at == heights.begin() ? out.low - 1 : *std::prev(at);
    if (next < out.low && free_between(next, out.low)) break;
  }
  for (auto at = above; at != heights.end(); ++at) {
    out.high = *at;
    const double next = std::next(at) == heights.end() ? out.high + 1 : *std::next(at);
    if (next > out.high && free_between(out.high, next)) break;
  }
  return out;
}

}  // namespace riffler::plan
