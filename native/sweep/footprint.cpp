#include "sweep/footprint.hpp"

#include <cmath>

namespace riffler {

Footprint::Footprint(std::span<const Piece> pieces, std::initializer_list<Pose> poses, double slack) {
  for (const Piece& piece : pieces) {
    Hull& hull = hulls_[count_++];
    const double radius = max_radius(piece);
    hull.thickness = radius + slack;
    const auto* round = std::get_if<Round>(&piece);
    // Of a whole ball only the centre matters.
    const bool ball = round && round->e == 0 && round->z0 <= round->zc - round->r && round->z1 >= round->zc + round->r;
    for (const Pose& pose : poses) {
      const double reach = ball ? hull.thickness : radius * std::hypot(pose.axis.x, pose.axis.y) + slack;
      const auto add = [&](double z) {
        const Vec3 p = pose.tip + z * pose.axis;
        add_corner(hull, {p.x, p.y});
        rows_.include(p.x - hull.thickness), rows_.include(p.x + hull.thickness);
        columns_.include(p.y - hull.thickness), columns_.include(p.y + hull.thickness);
        height_.include(p.z - reach), height_.include(p.z + reach);
      };
      if (ball)
        add(round->zc);
      else
        add(bottom(piece)), add(top(piece));
    }
  }
}

void Footprint::add_corner(Hull& hull, const Vec2& p) {
  for (int k = 0; k < hull.corners; ++k) {
    const Vec2 edge = p - hull.corner[k];
    // A side that stands at one u ends where a corner's disc ends too.
    if (edge.x == 0) continue;
    const Vec2 across = Vec2(-edge.y, edge.x) * (hull.thickness / glm::length(edge));
    for (const Vec2 from : {p + across, p - across}) {
      const double slope = edge.y / edge.x, other = from.x - edge.x;
      hull.side[hull.sides++] = {std::min(from.x, other), std::max(from.x, other), from.x, from.y, slope};
    }
  }
  hull.corner[hull.corners++] = p;
}

Interval Footprint::row(double u) const {
  Interval out;
  for (std::size_t k = 0; k < count_; ++k) {
    const Hull& hull = hulls_[k];
    for (int i = 0; i < hull.corners; ++i) {
      const Vec2 p = hull.corner[i];
      const double half = hull.thickness * hull.thickness - (u - p.x) * (u - p.x);
      if (half < 0) continue;
      const double root = std::sqrt(half);
      out.include(p.y - root), out.include(p.y + root);
    }
    // The hull's edges are among the connections of its corners.
    for (int i = 0; i < hull.sides; ++i)
      if (const Side& s = hull.side[i]; u >= s.from && u <= s.to) out.include(s.y + s.slope * (u - s.x));
  }
  return out;
}

bool Footprint::overlaps(const Box3& box) const {
  return rows_.near <= box.upper.x && rows_.far >= box.lower.x && columns_.near <= box.upper.y &&
         columns_.far >= box.lower.y && height_.near <= box.upper.z && height_.far >= box.lower.z;
}

}  // namespace riffler
