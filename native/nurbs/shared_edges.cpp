#include "nurbs/shared_edges.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

#include "nurbs/mesh_plan.hpp"

namespace riffler::nurbs {

namespace {

/// Gives points that are within a distance of each other one number: that of the first of them.
class CornerWelder {
 public:
  explicit CornerWelder(double weld) : weld_(weld) {}

  int add(const Vec3& p, std::vector<Vec3>& corners) {
    const Vec3 cell = glm::floor(p / (4 * weld_));
    for (int k = 0; k < 27; ++k) {
      const auto found = cells_.find(key(cell + Vec3(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1)));
      if (found == cells_.end()) continue;
      for (const int other : found->second)
        if (glm::length(corners[static_cast<std::size_t>(other)] - p) <= weld_) return other;
    }
    const int number = static_cast<int>(corners.size());
    corners.push_back(p);
    cells_[key(cell)].push_back(number);
    return number;
  }

 private:
  /// Different cells may have one key: points are compared.
  static std::uint64_t key(const Vec3& cell) {
    std::uint64_t h = 0;
    for (int k = 0; k < 3; ++k) h = (h ^ static_cast<std::uint64_t>(std::llround(cell[k]))) * 0x9e3779b97f4a7c15ULL;
    return h;
  }

  double weld_;
  std::unordered_map<std::uint64_t, std::vector<int>> cells_;
};

/// Whether two curves are the same, parameters included: the same points, and weights in one ratio.
bool same_curve(const std::vector<Vec4>& a, const std::vector<Vec4>& b, double weld) {
  if (a.size() != b.size()) return false;
  double size = 0;
  for (const Vec4& h : a) size = std::max(size, glm::length(affine(h) - affine(a[0])));
  const double ratio = b[0].w / a[0].w;
  for (std::size_t k = 0; k < a.size(); ++k)
    if (!(glm::length(affine(a[k]) - affine(b[k])) <= weld && std::abs(b[k].w / a[k].w - ratio) * size <= weld * ratio))
      return false;
  return true;
}

std::vector<Vec4> side_of(const BezierSpan& span, int side) {
  const Degrees& d = span.degrees;
  std::vector<Vec4> points;
  if (side % 2 == 0)
    for (int i = 0; i <= d.u; ++i) points.push_back(span.net[d.at(i, side == 0 ? 0 : d.v)]);
  else
    for (int j = 0; j <= d.v; ++j) points.push_back(span.net[d.at(side == 1 ? d.u : 0, j)]);
  return points;
}

}  // namespace

std::int64_t EdgeUse::place(std::int64_t at) const {
  return reversed ? kGrid - at : at;
}

SharedEdges::SharedEdges(const std::vector<BezierSpan>& spans, double weld) : of_span(spans.size()) {
  CornerWelder welder(weld);
  std::map<std::pair<int, int>, std::vector<int>> between;  // edges between two corners
  for (std::size_t s = 0; s < spans.size(); ++s)
    for (int side = 0; side < 4; ++side) {
      std::vector<Vec4> points = side_of(spans[s], side);
      EdgeUse& use = of_span[s][static_cast<std::size_t>(side)];
      int a = welder.add(affine(points.front()), corners), b = welder.add(affine(points.back()), corners);
      const bool collapsed = std::all_of(points.begin(), points.end(), [&](const Vec4& h) {
        return glm::length(affine(h) - corners[static_cast<std::size_t>(a)]) <= 2 * weld;
      });
      std::vector<int>& others = between[std::minmax(a, b)];
      std::vector<Vec4> back(points.rbegin(), points.rend());
      bool found = false;
      for (const int other : others) {
        const SharedEdge& edge = edges[static_cast<std::size_t>(other)];
        const bool straight = !collapsed && same_curve(edge.points, points, weld);
        const bool reversed = !straight && !collapsed && same_curve(edge.points, back, weld);
        if (!straight && !reversed && !(collapsed && edge.collapsed)) continue;
        use = {other, reversed};
        found = true;
        break;
      }
      if (found) continue;
      use = {static_cast<int>(edges.size()), false};
      others.push_back(use.edge);
      edges.push_back({std::move(points), a, b, collapsed, {}});
    }
}

}  // namespace riffler::nurbs
