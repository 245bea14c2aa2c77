#include "plan/contours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace riffler::plan {

namespace {

/// The edges of the grid that curves cross, and for each the edge that follows. Edge 2 k leads from place k along x,
/// edge 2 k + 1 along y.
class Crossings {
 public:
  Crossings(const PlaceGrid& grid, const Field& field, double value,
            const std::optional<std::span<const std::size_t>>& cells)
      : grid_(grid), field_(field), value_(value) {
    if (cells)
      for (const std::size_t k : *cells) add_cell(k);
    else
      for (int row = 0; row + 1 < grid.rows; ++row)
        for (int column = 0; column + 1 < grid.columns; ++column) add_cell(grid.index(column, row));
    std::sort(joins_.begin(), joins_.end());
    for (const Join& join : joins_) ends_.push_back(join.second);
    std::sort(ends_.begin(), ends_.end());
  }

  /// Calls visit(edges, closed) for each curve.
  template <class Visit>
  void each(const Visit& visit) {
    std::vector<char> done(joins_.size(), 0);
    std::vector<std::size_t> edges;
    const auto follow = [&](std::size_t join) {
      edges.clear();
      const std::size_t first = joins_[join].first;
      while (join < joins_.size() && !done[join]) {
        done[join] = 1;
        edges.push_back(joins_[join].first);
        const std::size_t next = joins_[join].second;
        join = find(next);
        if (join == joins_.size() && next != first) edges.push_back(next);
      }
    };
    for (std::size_t k = 0; k < joins_.size(); ++k)
      if (!std::binary_search(ends_.begin(), ends_.end(), joins_[k].first)) follow(k), visit(edges, false);
    for (std::size_t k = 0; k < joins_.size(); ++k)
      if (!done[k]) follow(k), visit(edges, true);
  }
  /// Both ends of an edge; the end whose field is less than the value comes first.
  std::pair<std::size_t, std::size_t> ends(std::size_t edge) const {
    const std::size_t a = edge / 2, b = a + (edge % 2 ? static_cast<std::size_t>(grid_.columns) : 1);
    return less(a) ? std::pair(a, b) : std::pair(b, a);
  }

 private:
  using Join = std::pair<std::size_t, std::size_t>;

  std::size_t find(std::size_t edge) const {
    const auto at = std::lower_bound(joins_.begin(), joins_.end(), Join(edge, 0));
    return static_cast<std::size_t>((at != joins_.end() && at->first == edge ? at : joins_.end()) - joins_.begin());
  }
  bool less(std::size_t k) const { return field_[k] < value_; }

  /// Going around a cell counter-clockwise, a curve enters where the field stops being less than the value, and leaves
  /// where the field begins to be less.
  void add_cell(std::size_t cell) {
    const auto up = static_cast<std::size_t>(grid_.columns);
    const std::array<std::size_t, 4> k{cell, cell + 1, cell + up + 1, cell + up};
    double sum = 0;
    for (const std::size_t place : k) {
      if (!std::isfinite(field_[place])) return;
      sum += field_[place];
    }
    const std::array<std::size_t, 4> edge{2 * k[0], 2 * k[1] + 1, 2 * k[3], 2 * k[0] + 1};
    std::array<std::size_t, 2> in{}, out{};
    std::size_t ins = 0, outs = 0;
    bool first_in = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const bool here = less(k[i]), there = less(k[(i + 1) % 4]);
      if (here && !there) in[ins++] = edge[i], first_in = first_in || outs == 0;
      if (!here && there) out[outs++] = edge[i];
    }
    if (ins == 0) return;
    if (ins == 1) return join(in[0], out[0]);
    // Two curves: around the two places that are not less if the cell's middle is less, else around the other two.
    const bool near = (sum / 4 < value_) == first_in;
    join(in[0], out[near ? 0 : 1]), join(in[1], out[near ? 1 : 0]);
  }
  void join(std::size_t from, std::size_t to) { joins_.emplace_back(from, to); }

  const PlaceGrid& grid_;
  const Field& field_;
  double value_;
  std::vector<Join> joins_;  // pairs of an edge and the next one, ascending
  std::vector<std::size_t> ends_;
};

double distance_to_line(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 way = b - a;
  const double square = glm::dot(way, way);
  const double s = square > 0 ? std::clamp(glm::dot(p - a, way) / square, 0.0, 1.0) : 0;
  return glm::length(p - (a + s * way));
}

}  // namespace

std::vector<Curve> contours(const PlaceGrid& grid, const Field& field, double value,
                            const std::function<Vec2(std::size_t, std::size_t)>& crossing,
                            const std::optional<std::span<const std::size_t>>& cells) {
  Crossings crossings(grid, field, value, cells);
  std::vector<Curve> out;
  crossings.each([&](const std::vector<std::size_t>& edges, bool closed) {
    Curve& curve = out.emplace_back(Curve{{}, closed});
    for (const std::size_t e : edges) {
      const auto [less, more] = crossings.ends(e);
      const double share = (value - field[less]) / (field[more] - field[less]);
      curve.points.push_back(crossing ? crossing(less, more) : glm::mix(grid.place(less), grid.place(more), share));
    }
  });
  return out;
}

Curve simplified(const Curve& curve, double tolerance) {
  std::vector<Vec2> p = curve.points;
  if (curve.closed && !p.empty()) p.push_back(p.front());
  if (p.size() < 3) return curve;
  std::vector<char> keep(p.size(), 0);
  keep.front() = keep.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> open;
  const auto halve = [&](std::size_t a, std::size_t b) {
    if (b > a + 1) open.emplace_back(a, b);
  };
  if (curve.closed)
    keep[p.size() / 2] = 1, halve(0, p.size() / 2), halve(p.size() / 2, p.size() - 1);
  else
    halve(0, p.size() - 1);
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    std::size_t far = a;
    double most = tolerance;
    for (std::size_t k = a + 1; k < b; ++k)
      if (const double d = distance_to_line(p[k], p[a], p[b]); d > most) most = d, far = k;
    if (far == a) continue;
    keep[far] = 1, halve(a, far), halve(far, b);
  }
  Curve out{{}, curve.closed};
  for (std::size_t k = 0; k + (curve.closed ? 1 : 0) < p.size(); ++k)
    if (keep[k]) out.points.push_back(p[k]);
  return out;
}

}  // namespace riffler::plan
