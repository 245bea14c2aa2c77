// Places the vertex of a cycle.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "marching/bricks.hpp"
#include "marching/cases.hpp"
#include "marching/float_grid.hpp"
#include "marching/hits.hpp"
#include "marching/qef.hpp"

namespace riffler::marching {

/// A cycle of a cell, with the hits of its edges in the entry's order.
struct Cycle {
  Vec3i cell;
  const CellCase& entry;
  int number;
  std::array<const Hit*, 12> hits;  // from entry.begin[number] on
};

struct Placed {
  Vec3 place;
  std::uint8_t marks = 0;
  Vec3 anchor, other;  // for a special vertex: its anchor and candidate
};

/// Sums over the hits of a cycle, in cell units. Floats are precise enough for means of a few values.
class CycleSums {
 public:
  void add(int edge, const Hit& hit) {
    place_[kEdges[edge].axis] += hit.place;
    for (int a = 0; a < 3; ++a) normal_[a] += hit.normal[a];
  }

  /// Returns true if the surface in the cell is flat or smooth and its vertex `x` falls into the cell. `hit(n)` is the
  /// hit of the entry's n-th edge.
  template <class HitAt>
  bool smooth(const CellCase& entry, int c, HitAt&& hit, Vec3& x) const {
    constexpr double flat = 0.999999;  // |mean normal|²: above it, an exact fit gains less than 10⁻⁴ cells
    const double count = entry.begin[c + 1] - entry.begin[c], most = count * count;
    const Vec3 normal(normal_[0], normal_[1], normal_[2]);
    const double agreement = glm::dot(normal, normal);
    // At most four edges per axis, places from −½ to 1½: only a weak hit makes a sum so small.
    const bool weak = std::min({place_[0], place_[1], place_[2]}) < -Hit::kWeak / 2;
    if (weak || !(agreement > kSmooth * most)) return false;
    const auto& from = entry.from[c];
    x = Vec3(place_[0] + static_cast<float>(from[0]), place_[1] + static_cast<float>(from[1]),
             place_[2] + static_cast<float>(from[2])) *
        (1 / count);
    if (agreement <= flat * most) {
      // On a sphere the tangent planes err by +d²/2R and the mean of the hits by −d²/2R: half way they cancel.
      float along = 0;
      for (int n = entry.begin[c]; n < entry.begin[c + 1]; ++n) along += along_normal(entry.edge[n], hit(n));
      x += normal * (0.5 * (along - glm::dot(normal, x)) / agreement);
    }
    return FloatGrid::in_cell(x);
  }

 private:
  static float along_normal(int edge, const Hit& hit) {
    const CellEdge& shape = kEdges[edge];
    float along = hit.normal[shape.axis] * hit.place;
    for (int a = 0; a < 3; ++a) along += hit.normal[a] * static_cast<float>(shape.from[a]);
    return along;
  }

  float place_[3] = {}, normal_[3] = {};
};

/// The previous vertices of the same cell. No two share a place, so at most one may leave the cell.
struct Siblings {
  std::vector<Vec3> places;
  bool left = false;  // one of them has a candidate
};

/// Places the vertex of a cycle that is not `smooth` and alone in its cell.
Placed place_vertex(const FloatGrid& grid, const Cycle& cycle, const Siblings& siblings);

}  // namespace riffler::marching
