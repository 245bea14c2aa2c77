#include "plan/place_grid.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <utility>

#include "geom/math.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

/// Lower envelope of the parabolas (x − k)² + f(k) along one row or column; its values replace f.
struct Parabolas {
  std::vector<int> at;
  std::vector<double> from, out;

  explicit Parabolas(int n) : at(static_cast<std::size_t>(n)), from(at.size() + 1), out(at.size()) {}

  void run(double* f, std::size_t stride) {
    const int n = static_cast<int>(at.size());
    const auto value = [&](int k) { return f[static_cast<std::size_t>(k) * stride]; };
    int count = 0;
    for (int k = 0; k < n; ++k) {
      if (value(k) == kInfinity) continue;
      double cross = -kInfinity;
      while (count > 0) {
        const int last = at[count - 1];
        cross = (value(k) - value(last) + static_cast<double>(k) * k - static_cast<double>(last) * last) /
                (2.0 * (k - last));
        if (cross > from[count - 1]) break;
        --count, cross = -kInfinity;
      }
      at[count] = k, from[count] = cross, ++count;
    }
    if (count == 0) return;
    for (int k = 0, part = 0; k < n; ++k) {
      while (part + 1 < count && from[part + 1] < k) ++part;
      out[k] = static_cast<double>(k - at[part]) * (k - at[part]) + value(at[part]);
    }
    for (int k = 0; k < n; ++k) f[static_cast<std::size_t>(k) * stride] = out[k];
  }
};

}  // namespace

std::size_t PlaceGrid::nearest(const Vec2& p) const {
  const auto along = [&](double x, double low, int n) {
    return static_cast<int>(std::clamp(std::floor((x - low) / spacing + 0.5), 0.0, static_cast<double>(n - 1)));
  };
  return index(along(p.x, lower.x, columns), along(p.y, lower.y, rows));
}

Field distance_to(const PlaceGrid& grid, const PlaceSet& set) {
  Field out(grid.size());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = set[k] ? 0 : kInfinity;
  const auto columns = static_cast<std::size_t>(grid.columns), rows = static_cast<std::size_t>(grid.rows);
  base::parallel_for(rows, 64, [&](std::size_t begin, std::size_t end) {
    Parabolas line(grid.columns);
    for (std::size_t k = begin; k < end; ++k) line.run(out.data() + k * columns, 1);
  });
  base::parallel_for(columns, 64, [&](std::size_t begin, std::size_t end) {
    Parabolas line(grid.rows);
    for (std::size_t k = begin; k < end; ++k) line.run(out.data() + k, columns);
  });
  for (double& x : out) x = grid.spacing * std::sqrt(x);
  return out;
}

PlaceSet without_slivers(const PlaceGrid& grid, const PlaceSet& set, double width) {
  PlaceSet out(set.size());
  for (std::size_t k = 0; k < set.size(); ++k) out[k] = !set[k];
  const Field deep = distance_to(grid, out);
  for (std::size_t k = 0; k < set.size(); ++k) out[k] = set[k] && deep[k] > 0.5 * width;
  const Field near = distance_to(grid, out);
  for (std::size_t k = 0; k < set.size(); ++k) out[k] = set[k] && near[k] <= 0.5 * width + 2 * grid.spacing;
  return out;
}

Field path_lengths(const PlaceGrid& grid, const PlaceSet& in, const PlaceSet& from) {
  Field out(grid.size(), kInfinity);
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < out.size(); ++k)
    if (from[k]) places.push_back(k);
  add_path_lengths(grid, in, places, out);
  return out;
}

void add_path_lengths(const PlaceGrid& grid, const PlaceSet& in, const std::vector<std::size_t>& from, Field& lengths) {
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
  for (const std::size_t k : from)
    if (in[k]) lengths[k] = 0, front.emplace(0.0, k);
  const auto at = [&](int column, int row) {
    if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return kInfinity;
    const std::size_t k = grid.index(column, row);
    return in[k] ? lengths[k] : kInfinity;
  };
  const auto update = [&](int column, int row, double least) {
    if (column < 0 || row < 0 || column >= grid.columns || row >= grid.rows) return;
    const std::size_t k = grid.index(column, row);
    if (!in[k] || lengths[k] <= least) return;
    double a = std::min(at(column - 1, row), at(column + 1, row)),
           b = std::min(at(column, row - 1), at(column, row + 1));
    if (a > b) std::swap(a, b);
    const double g = grid.spacing;
    const double value = b - a >= g ? a + g : 0.5 * (a + b + std::sqrt(2 * g * g - (b - a) * (b - a)));
    if (value < lengths[k]) lengths[k] = value, front.emplace(value, k);
  };
  while (!front.empty()) {
    const auto [value, k] = front.top();
    front.pop();
    if (value > lengths[k]) continue;
    const int column = static_cast<int>(k % static_cast<std::size_t>(grid.columns)),
              row = static_cast<int>(k / static_cast<std::size_t>(grid.columns));
    update(column - 1, row, value), update(column + 1, row, value);
    update(column, row - 1, value), update(column, row + 1, value);
  }
}

}  // namespace riffler::plan
