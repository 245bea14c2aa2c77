#include "plan/outline/border.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "geom/math.hpp"

namespace riffler::plan {

namespace {

constexpr double kMostCells = 4e6;

Vec2 nearest_on(const SetBorder::Segment& s, const Vec2& p) {
  const Vec2 way = s.to - s.from;
  const double square = glm::dot(way, way);
  return square > 0 ? s.from + std::clamp(glm::dot(p - s.from, way) / square, 0.0, 1.0) * way : s.from;
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x * b.y - a.y * b.x;
}

bool crosses(const SetBorder::Segment& s, const SetBorder::Segment& t) {
  const auto sides = [](const SetBorder::Segment& line, const SetBorder::Segment& ends) {
    return cross(line.to - line.from, ends.from - line.from) * cross(line.to - line.from, ends.to - line.from) < 0;
  };
  return sides(s, t) && sides(t, s);
}

double distance_between(const SetBorder::Segment& s, const SetBorder::Segment& t) {
  if (crosses(s, t)) return 0;
  return std::min({glm::length(nearest_on(s, t.from) - t.from), glm::length(nearest_on(s, t.to) - t.to),
                   glm::length(nearest_on(t, s.from) - s.from), glm::length(nearest_on(t, s.to) - s.to)});
}

/// Calls visit(k) for each place of the grid that the triangle covers.
template <class Visit>
void fill(const PlaceGrid& grid, const std::array<Vec2, 3>& t, const Visit& visit) {
  const auto [low, high] = std::minmax({t[0].y, t[1].y, t[2].y});
  const int first = std::max(0, static_cast<int>(std::ceil((low - grid.lower.y) / grid.spacing)));
  const int last = std::min(grid.rows - 1, static_cast<int>(std::floor((high - grid.lower.y) / grid.spacing)));
  for (int row = first; row <= last; ++row) {
    const double y = grid.lower.y + row * grid.spacing;
    double left = kInfinity, right = -kInfinity;
    for (int k = 0; k < 3; ++k) {
      const Vec2 &a = t[static_cast<std::size_t>(k)], &b = t[static_cast<std::size_t>((k + 1) % 3)];
      if (std::min(a.y, b.y) > y || std::max(a.y, b.y) < y) continue;
      const double x = a.y == b.y ? a.x : a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
      left = std::min({left, x, a.y == b.y ? b.x : x}), right = std::max({right, x, a.y == b.y ? b.x : x});
    }
    const int from = std::max(0, static_cast<int>(std::ceil((left - grid.lower.x) / grid.spacing)));
    const int to = std::min(grid.columns - 1, static_cast<int>(std::floor((right - grid.lower.x) / grid.spacing)));
    for (int column = from; column <= to; ++column) visit(grid.index(column, row));
  }
}

}  // namespace

SetBorder::SetBorder(std::vector<Segment> segments, double cell) : segments_(std::move(segments)), cell_(cell) {
  if (segments_.empty()) return;
  lower_ = upper_ = segments_.front().from;
  for (const Segment& s : segments_)
    lower_ = glm::min(lower_, glm::min(s.from, s.to)), upper_ = glm::max(upper_, glm::max(s.from, s.to));
  const Vec2 size = upper_ - lower_;
  cell_ = std::max({cell_, std::sqrt(size.x * size.y / kMostCells), std::max(size.x, size.y) / kMostCells});
  columns_ = static_cast<int>(size.x / cell_) + 1, rows_ = static_cast<int>(size.y / cell_) + 1;
  const auto each = [&](const auto& visit) {
    for (std::size_t k = 0; k < segments_.size(); ++k) {
      const Vec2 low = (glm::min(segments_[k].from, segments_[k].to) - lower_) / cell_,
                 high = (glm::max(segments_[k].from, segments_[k].to) - lower_) / cell_;
      for (int row = static_cast<int>(low.y); row <= std::min(rows_ - 1, static_cast<int>(high.y)); ++row)
        for (int column = static_cast<int>(low.x); column <= std::min(columns_ - 1, static_cast<int>(high.x)); ++column)
          visit(k,
                static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column));
    }
  };
  first_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
  each([&](std::size_t, std::size_t at) { ++first_[at + 1]; });
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  in_cells_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  each([&](std::size_t k, std::size_t at) { in_cells_[next[at]++] = k; });
}

template <class Visit>
void SetBorder::near(const Vec2& low, const Vec2& high, const Visit& visit) const {
  const Vec2 from = (low - lower_) / cell_, to = (high - lower_) / cell_;
  const int last_row = static_cast<int>(std::min(to.y, rows_ - 1.0)),
            last_column = static_cast<int>(std::min(to.x, columns_ - 1.0));
  if (to.x < 0 || to.y < 0) return;
  for (int row = static_cast<int>(std::max(from.y, 0.0)); row <= last_row; ++row)
    for (int column = static_cast<int>(std::max(from.x, 0.0)); column <= last_column; ++column) {
      const std::size_t at =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
      for (std::size_t k = first_[at]; k < first_[at + 1]; ++k) visit(segments_[in_cells_[k]]);
    }
}

bool SetBorder::nearest(const Vec2& p, double far, Vec2& found) const {
  double best = far;
  near(p - Vec2(far), p + Vec2(far), [&](const Segment& s) {
    const Vec2 q = nearest_on(s, p);
    if (const double d = glm::length(q - p); d < best) best = d, found = q;
  });
  return best < far;
}

double SetBorder::distance(const Vec2& a, const Vec2& b, double far) const {
  double best = far;
  near(glm::min(a, b) - Vec2(far), glm::max(a, b) + Vec2(far),
       [&](const Segment& s) { best = std::min(best, distance_between({a, b}, s)); });
  return best;
}

std::vector<SetBorder::Segment> silhouette_segments(const Mesh& mesh) {
  // Vertices with equal coordinates count as one.
  std::vector<std::size_t> order(mesh.vertices.size()), same(mesh.vertices.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
  const auto key = [&](std::size_t k) {
    const Vec3& v = mesh.vertices[k];
    return std::array<double, 3>{v.x, v.y, v.z};
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t k = 0; k < order.size(); ++k)
    same[order[k]] = k > 0 && key(order[k]) == key(order[k - 1]) ? same[order[k - 1]] : order[k];
  struct Edge {
    std::size_t from, to;
    int side;  // side of the edge on which the triangle is seen: 1 or −1; 0: the triangle is seen edge-on
    bool operator<(const Edge& other) const { return std::pair(from, to) < std::pair(other.from, other.to); }
  };
  std::vector<Edge> edges;
  for (const Vec3i& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::size_t a = same[static_cast<std::size_t>(t[k])], b = same[static_cast<std::size_t>(t[(k + 1) % 3])],
                        c = same[static_cast<std::size_t>(t[(k + 2) % 3])];
      if (a == b) continue;
      const Vec2 from(mesh.vertices[std::min(a, b)]), to(mesh.vertices[std::max(a, b)]);
      const double area = cross(to - from, Vec2(mesh.vertices[c]) - from);
      edges.push_back({std::min(a, b), std::max(a, b), area > 0 ? 1 : area < 0 ? -1 : 0});
    }
  std::stable_sort(edges.begin(), edges.end());
  std::vector<SetBorder::Segment> out;
  for (std::size_t k = 0; k < edges.size();) {
    std::size_t end = k;
    while (end < edges.size() && edges[end].from == edges[k].from && edges[end].to == edges[k].to) ++end;
    const bool between = end == k + 2 && edges[k].side * edges[k + 1].side < 0;
    const Vec2 from(mesh.vertices[edges[k].from]), to(mesh.vertices[edges[k].to]);
    if (!between && from != to) out.push_back({from, to});
    k = end;
  }
  return out;
}

PlaceSet covered(const PlaceGrid& grid, const Mesh& mesh) {
  PlaceSet out(grid.size(), 0);
  for (const Vec3i& t : mesh.triangles) {
    const auto corner = [&](int k) { return Vec2(mesh.vertices[static_cast<std::size_t>(t[k])]); };
    fill(grid, {corner(0), corner(1), corner(2)}, [&](std::size_t k) { out[k] = 1; });
  }
  return out;
}

std::vector<SetBorder::Segment> curve_segments(const std::vector<std::vector<Vec2>>& curves) {
  std::vector<SetBorder::Segment> out;
  for (const auto& curve : curves)
    for (std::size_t k = 0, j = curve.size() - 1; k < curve.size(); j = k++)
      if (curve[j] != curve[k]) out.push_back({curve[j], curve[k]});
  return out;
}

PlaceSet within(const PlaceGrid& grid, const std::vector<std::vector<Vec2>>& curves) {
  PlaceSet out(grid.size(), 0);
  std::vector<double> at;
  for (int row = 0; row < grid.rows; ++row) {
    const double y = grid.lower.y + row * grid.spacing;
    at.clear();
    for (const SetBorder::Segment& s : curve_segments(curves))
      if ((s.from.y > y) != (s.to.y > y))
        at.push_back(s.from.x + (y - s.from.y) / (s.to.y - s.from.y) * (s.to.x - s.from.x));
    std::sort(at.begin(), at.end());
    for (int column = 0; column < grid.columns; ++column) {
      const double x = grid.lower.x + column * grid.spacing;
      const auto before = std::lower_bound(at.begin(), at.end(), x) - at.begin();
      out[grid.index(column, row)] = before % 2 != 0;
    }
  }
  return out;
}

}  // namespace riffler::plan
