#include "nurbs/cell_polygon.hpp"

#include <cstddef>
#include <limits>

namespace riffler::nurbs {

namespace {

void merge_poles(std::vector<CornerOfCell>& polygon) {
  std::size_t kept = 0;
  for (const CornerOfCell& c : polygon) {
    if (kept > 0 && polygon[kept - 1].vertex == c.vertex)
      polygon[kept - 1].sides |= c.sides;
    else
      polygon[kept++] = c;
  }
  while (kept > 1 && polygon[kept - 1].vertex == polygon[0].vertex) polygon[0].sides |= polygon[--kept].sides;
  polygon.resize(kept);
}

/// Whether all corners but that at `left_out` lie on one side.
bool flat_without(const std::vector<CornerOfCell>& polygon, std::size_t left_out) {
  unsigned common = ~0U;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (i != left_out) common &= polygon[i].sides;
  return common != 0;
}

}  // namespace

void append_triangles(std::vector<CornerOfCell>& polygon, const mesh::Vertices& vertices,
                      std::vector<Vec3i>& triangles) {
  merge_poles(polygon);
  const auto add = [&](const CornerOfCell& a, const CornerOfCell& b, const CornerOfCell& c) {
    if (a.vertex != b.vertex && b.vertex != c.vertex && c.vertex != a.vertex)
      triangles.emplace_back(a.vertex, b.vertex, c.vertex);
  };
  while (polygon.size() > 3) {
    std::size_t best = polygon.size();
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const CornerOfCell &a = polygon[(i + polygon.size() - 1) % polygon.size()], &b = polygon[i],
                         &c = polygon[(i + 1) % polygon.size()];
      if ((a.sides & b.sides & c.sides) != 0) continue;
      const Vec3 d = vertices[static_cast<std::size_t>(c.vertex)] - vertices[static_cast<std::size_t>(a.vertex)];
      const double length = glm::dot(d, d);
      if (!(length < shortest) || flat_without(polygon, i)) continue;
      best = i, shortest = length;
    }
    if (best == polygon.size()) return;  // all on one side: a cell without area
    add(polygon[(best + polygon.size() - 1) % polygon.size()], polygon[best], polygon[(best + 1) % polygon.size()]);
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>(best));
  }
  if (polygon.size() == 3 && (polygon[0].sides & polygon[1].sides & polygon[2].sides) == 0)
    add(polygon[0], polygon[1], polygon[2]);
}

}  // namespace riffler::nurbs
