#include "reference/surface_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace riffler::reference {

namespace {

Vec3 middle(const Corners& t) {
  return (t[0] + t[1] + t[2]) / 3.0;
}

/// Largest distance of the triangle's points from its middle.
double radius(const Corners& t) {
  const Vec3 m = middle(t);
  return std::max({glm::length(t[0] - m), glm::length(t[1] - m), glm::length(t[2] - m)});
}

struct Cell {
  double lower;
  Corners corners;
  std::size_t triangle;
  bool operator<(const Cell& o) const { return lower > o.lower; }  // examine the smallest first
};

/// The point of the triangle's plane at barycentric coordinates u and v.
Vec3 at(const Corners& t, double u, double v) {
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

/// Compass search in the triangle with halving steps. All values that it finds are attained.
double polished(const Corners& t, const AssemblyDistance& tool, const Pose& pose, double step, Vec3& point,
                double value) {
  // Barycentric coordinates of the start, from the normal equations.
  const Vec3 a = t[1] - t[0], b = t[2] - t[0], d = point - t[0];
  const double aa = glm::dot(a, a), ab = glm::dot(a, b), bb = glm::dot(b, b), det = aa * bb - ab * ab;
  if (!(det > 1e-14 * aa * bb)) return value;
  const double ad = glm::dot(a, d), bd = glm::dot(b, d), size = std::sqrt(std::max(aa, bb));
  double u = std::clamp((bb * ad - ab * bd) / det, 0.0, 1.0), v = std::clamp((aa * bd - ab * ad) / det, 0.0, 1.0 - u);
  constexpr double kWays[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, -1}, {-1, 1}, {1, 1}, {-1, -1}};
  for (double h = std::min(0.5, step / size); h > 1e-13;) {
    bool better = false;
    for (const auto& way : kWays) {
      const double x = std::clamp(u + h * way[0], 0.0, 1.0), y = std::clamp(v + h * way[1], 0.0, 1.0 - x);
      const Vec3 p = at(t, x, y);
      if (const double f = tool(p, pose); f < value) u = x, v = y, value = f, point = p, better = true;
    }
    if (!better) h *= 0.5;
  }
  return value;
}

}  // namespace

SpreadPoints spread_points(std::span<const Corners> triangles, std::size_t count) {
  SpreadPoints out;
  double total = 0;
  const auto area = [](const Corners& t) { return 0.5 * glm::length(glm::cross(t[1] - t[0], t[2] - t[0])); };
  for (const Corners& t : triangles) total += area(t);
  for (const Corners& t : triangles) {
    const double share = total > 0 ? area(t) / total * static_cast<double>(count) : 0;
    const int n = std::max(1, static_cast<int>(std::ceil(std::sqrt(share))));
    out.spacing = std::max(out.spacing, radius(t) / n);
    // n² small triangles similar to the whole one: upright ones, and inverted ones between them.
    const auto corner = [&](int i, int j) { return at(t, static_cast<double>(i) / n, static_cast<double>(j) / n); };
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        out.points.push_back(middle({corner(i, j), corner(i + 1, j), corner(i, j + 1)}));
        if (i + j < n - 1) out.points.push_back(middle({corner(i + 1, j + 1), corner(i + 1, j), corner(i, j + 1)}));
      }
  }
  return out;
}

double least_over(std::span<const Vec3> points, const AssemblyDistance& tool, const Pose& pose) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) least = std::min(least, tool(p, pose));
  return least;
}

SurfaceBracket least_distance(std::span<const Corners> triangles, const AssemblyDistance& tool, const Pose& pose,
                              double gap, std::size_t most) {
  SurfaceBracket out{0, std::numeric_limits<double>::infinity(), Vec3(0)};
  std::priority_queue<Cell> cells;
  std::size_t looked = 0, best = 0;
  const auto look = [&](const Vec3& p, std::size_t triangle) {
    const double f = tool(p, pose);
    if (f < out.upper) out.upper = f, out.point = p, best = triangle;
    return f;
  };
  const auto add = [&](const Corners& t, std::size_t triangle) {
    ++looked;
    const double lower = look(middle(t), triangle) - radius(t);
    if (lower < out.upper - gap) cells.push({lower, t, triangle});
  };
  for (std::size_t k = 0; k < triangles.size(); ++k) {
    for (const Vec3& corner : triangles[k]) look(corner, k);
    add(triangles[k], k);
  }
  double polished_at = std::numeric_limits<double>::infinity();
  for (; !cells.empty() && cells.top().lower < out.upper - gap && looked < most;) {
    const Cell cell = cells.top();
    cells.pop();
    const auto& [a, b, c] = cell.corners;
    const Vec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    add({a, ab, ca}, cell.triangle), add({ab, b, bc}, cell.triangle), add({ca, bc, c}, cell.triangle);
    add({bc, ca, ab}, cell.triangle);
    // After a large improvement, refine to the local minimum, so that cells above it need not be divided.
    if (out.upper < polished_at - gap)
      polished_at = out.upper = polished(triangles[best], tool, pose, radius(cell.corners), out.point, out.upper);
  }
  out.upper = polished(triangles[best], tool, pose, 1e-2, out.point, out.upper);
  out.lower = cells.empty() ? out.upper - gap : std::min(out.upper - gap, cells.top().lower);
  return out;
}

}  // namespace riffler::reference
