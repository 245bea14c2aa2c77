#include "plan/rough/entry.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr double kHelixTurn = kPi / 18;  // angle between two points of a helix, rad

Vec2 on_helix(const Entry& entry, int k) {
  return entry.path.front() + entry.radius * Vec2(base::cos(k * kHelixTurn), base::sin(k * kHelixTurn));
}

}  // namespace

double length_of(const std::vector<Vec2>& path) {
  double out = 0;
  for (std::size_t k = 1; k < path.size(); ++k) out += glm::length(path[k] - path[k - 1]);
  return out;
}

std::vector<Vec3> way_down(const Entry& entry, double top, double z, double slope) {
  std::vector<Vec3> out;  // in upward order; reversed at the end
  const double rate = base::tan(slope);
  if (entry.radius > 0) {
    const double up = 2 * entry.radius * base::sin(0.5 * kHelixTurn) * rate;
    for (int k = 0;; ++k) {
      out.emplace_back(on_helix(entry, -k), std::min(top, z + k * up));
      if (out.back().z >= top) break;
    }
  } else {
    double at = z;
    out.emplace_back(entry.path.front(), at);
    for (std::size_t k = 0, n = entry.path.size(), forth = 1; at < top;) {
      const std::size_t next = forth ? k + 1 : k - 1;
      const double length = glm::length(entry.path[next] - entry.path[k]), rise = length * rate;
      const double share = at + rise > top ? (top - at) / rise : 1;
      at = share < 1 ? top : at + rise;
      out.emplace_back(glm::mix(entry.path[k], entry.path[next], share), at);
      k = next;
      if (k == 0 || k + 1 == n) forth = k == 0;
    }
  }
  std::reverse(out.begin(), out.end());
  return out;
}

std::vector<Vec3> level_way(const Entry& entry, double z) {
  std::vector<Vec3> out;
  if (entry.radius > 0) {
    for (int k = 0; k <= static_cast<int>(std::round(2 * kPi / kHelixTurn)); ++k)
      out.emplace_back(on_helix(entry, k), z);
    out.emplace_back(entry.path.front(), z);
  } else {
    for (const Vec2& p : entry.path) out.emplace_back(p, z);
  }
  return out;
}

std::vector<Vec2> ramp_from(const PlaceGrid& grid, const PlaceSet& in, std::size_t start, double length) {
  // Dijkstra's search over eight neighbours, within a window that contains every place near enough.
  const auto columns = static_cast<std::size_t>(grid.columns);
  const int reach = static_cast<int>(length / grid.spacing) + 1, side = 2 * reach + 1;
  const int column0 = static_cast<int>(start % columns) - reach, row0 = static_cast<int>(start / columns) - reach;
  std::vector<double> far(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), kInfinity);
  std::vector<int> before(far.size(), -1);
  std::vector<std::pair<double, int>> front{{0, reach * side + reach}};
  far[static_cast<std::size_t>(front[0].second)] = 0;
  const auto place = [&](int k) { return grid.index(column0 + k % side, row0 + k / side); };
  int last = front[0].second;
  while (!front.empty()) {
    std::pop_heap(front.begin(), front.end(), std::greater<>());
    const auto [way, k] = front.back();
    front.pop_back();
    if (way > far[static_cast<std::size_t>(k)]) continue;
    last = k;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int x = k % side + dx, y = k / side + dy;
        if (x < 0 || y < 0 || x >= side || y >= side) continue;
        if (column0 + x < 0 || row0 + y < 0 || column0 + x >= grid.columns || row0 + y >= grid.rows) continue;
        const int next = y * side + x;
        const double there = way + grid.spacing * std::sqrt(static_cast<double>(dx * dx + dy * dy));
        if (there > length || !in[place(next)] || there >= far[static_cast<std::size_t>(next)]) continue;
        far[static_cast<std::size_t>(next)] = there, before[static_cast<std::size_t>(next)] = k;
        front.emplace_back(there, next), std::push_heap(front.begin(), front.end(), std::greater<>());
      }
  }
  std::vector<Vec2> out;
  for (int k = last; k >= 0; k = before[static_cast<std::size_t>(k)]) out.push_back(grid.place(place(k)));
  std::reverse(out.begin(), out.end());
  return out;
}

}  // namespace riffler::plan
