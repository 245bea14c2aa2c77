#include "plan/rough/clear_paths.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace riffler::plan {

namespace {

constexpr double kLeaving = 3, kJoining = 5;  // spacings around a path's ends within which it may touch cells

}  // namespace

ClearPaths::ClearPaths(const PlaceGrid& grid, const PlaceSet& in, const PlaceSet& standing, const Layer& layer,
                       double radius)
    : grid_(&grid),
      in_(&in),
      standing_(grid, standing),
      layer_(&layer),
      radius_(radius),
      known_(grid.size(), 0),
      lengths_(grid.size()),
      round_(grid.size(), 0),
      before_(grid.size()) {}

bool ClearPaths::free(std::size_t place) {
  if (!known_[place] && (*in_)[place] && layer_->frees(grid_->place(place))) known_[place] = 1;
  return known_[place] != 0;
}

/// Whether the cutter may be at `p` on a path from `from` to `to`.
bool ClearPaths::open(const Vec2& p, const Vec2& from, const Vec2& to) {
  if (!(*in_)[grid_->nearest(p)]) return false;
  const auto within = [&](const Vec2& end, double spacings) {
    return glm::dot(p - end, p - end) <= spacings * spacings * grid_->spacing * grid_->spacing;
  };
  if (within(to, kJoining) && layer_->spares(p, kSpared)) return true;
  if (from != to && within(from, kLeaving) && layer_->spares(p, 0)) return true;
  return layer_->frees(p);
}

bool ClearPaths::straight(const Vec2& a, const Vec2& b, const Vec2& from, const Vec2& to) {
  const int steps = 1 + static_cast<int>(glm::length(b - a) / grid_->spacing);
  for (int k = 0; k <= steps; ++k)
    if (!open(glm::mix(a, b, static_cast<double>(k) / steps), from, to)) return false;
  return true;
}

std::vector<Vec2> ClearPaths::search(const Vec2& from, const Vec2& aim, bool aimed, double most,
                                     const std::function<bool(std::size_t)>& found) {
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  const auto columns = static_cast<std::size_t>(grid_->columns);
  const double g = grid_->spacing;
  const auto left = [&](std::size_t k) { return aimed ? glm::length(grid_->place(k) - aim) : 0.0; };
  const auto add = [&](std::size_t k, double length, std::size_t before) {
    if (round_[k] == rounds_ && lengths_[k] <= length) return;
    const double whole = length + left(k);
    if (whole > most || (!free(k) && !open(grid_->place(k), from, aim))) return;
    round_[k] = rounds_, lengths_[k] = length, before_[k] = static_cast<std::uint32_t>(before);
    front.emplace(whole, k);
  };
  ++rounds_;
  const std::size_t first = grid_->nearest(from);
  add(first, 0, first);
  while (!front.empty()) {
    const auto [whole, k] = front.top();
    front.pop();
    if (whole > lengths_[k] + left(k)) continue;
    if (found(k)) {
      std::vector<Vec2> way{grid_->place(k)};
      for (std::size_t at = k; at != first;) at = before_[at], way.push_back(grid_->place(at));
      std::reverse(way.begin(), way.end());
      return way;
    }
    const int column = static_cast<int>(k % columns), row = static_cast<int>(k / columns);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int c = column + dx, r = row + dy;
        if ((dx == 0 && dy == 0) || c < 0 || r < 0 || c >= grid_->columns || r >= grid_->rows) continue;
        add(grid_->index(c, r), lengths_[k] + g * std::sqrt(static_cast<double>(dx * dx + dy * dy)), k);
      }
  }
  return {};
}

/// Appends the corners that the path needs after place `first`, up to place `last`.
void ClearPaths::pull(const std::vector<Vec2>& way, std::size_t first, std::size_t last, std::vector<Vec2>& out) {
  if (last == first + 1 || straight(way[first], way[last], way.front(), way.back())) {
    out.push_back(way[last]);
    return;
  }
  const std::size_t middle = first + (last - first) / 2;
  pull(way, first, middle, out), pull(way, middle, last, out);
}

std::vector<Vec2> ClearPaths::between(const Vec2& from, const Vec2& to, double most) {
  if (glm::length(to - from) > most) return {};
  if (straight(from, to, from, to)) return {from, to};
  const std::size_t last = grid_->nearest(to);
  std::vector<Vec2> way = search(from, to, true, most, [&](std::size_t k) { return k == last; });
  if (way.empty()) return {};
  way.insert(way.begin(), from), way.push_back(to);
  std::vector<Vec2> out{from};
  pull(way, 0, way.size() - 1, out);
  return out;
}

std::vector<Vec2> ClearPaths::from_above(const Vec2& to, double most) {
  const double radius = radius_ + (2 * kCellRadius + 0.01) * grid_->spacing;
  std::vector<Vec2> way = search(to, to, false, most, [&](std::size_t k) {
    return free(k) && layer_->frees(grid_->place(k), radius) && !standing_.any_within(grid_->place(k), radius);
  });
  if (way.empty()) return {};
  way.insert(way.begin(), to);
  std::reverse(way.begin(), way.end());
  std::vector<Vec2> out{way.front()};
  pull(way, 0, way.size() - 1, out);
  return out;
}

}  // namespace riffler::plan
