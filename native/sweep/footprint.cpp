#include "sweep/footprint.hpp"

#include <cmath>

namespace riffler {

Footprint::Footprint(const Piece& piece, std::initializer_list<Pose> poses, double slack)
    : thickness_(max_radius(piece) + slack) {
  const auto* round = std::get_if<Round>(&piece);
  // Of a whole ball only the centre matters.
  const bool ball = round && round->e == 0 && round->z0 <= round->zc - round->r && round->z1 >= round->zc + round->r;
  for (const Pose& pose : poses) {
    const double reach = ball ? thickness_ : max_radius(piece) * std::hypot(pose.axis.x, pose.axis.y) + slack;
    const auto add = [&](double z) {
      const Vec3 p = pose.tip + z * pose.axis;
      corner_[count_++] = {p.x, p.y};
      rows_.include(p.x - thickness_), rows_.include(p.x + thickness_);
      columns_.include(p.y - thickness_), columns_.include(p.y + thickness_);
      height_.include(p.z - reach), height_.include(p.z + reach);
    };
    if (ball)
      add(round->zc);
    else
      add(bottom(piece)), add(top(piece));
  }
}

Interval Footprint::row(double u) const {
  Interval out;
  for (int i = 0; i < count_; ++i) {
    const Vec2 p = corner_[i];
    const double half = thickness_ * thickness_ - (u - p.x) * (u - p.x);
    if (half >= 0) out.include(p.y - std::sqrt(half)), out.include(p.y + std::sqrt(half));
    // The hull's edges are among the connections of its corners; along each long side v is linear in u.
    for (int k = i + 1; k < count_; ++k) {
      const Vec2 edge = corner_[k] - p;
      const double length = glm::length(edge);
      if (edge.x == 0) continue;  // both long sides stand at one u each, where a corner's disc ends too
      const Vec2 side = Vec2(-edge.y, edge.x) * (thickness_ / length);
      for (const Vec2 from : {p + side, p - side}) {
        const double t = (u - from.x) / edge.x;
        if (t >= 0 && t <= 1) out.include(from.y + t * edge.y);
      }
    }
  }
  return out;
}

bool Footprint::overlaps(const Box3& box) const {
  return rows_.near <= box.upper.x && rows_.far >= box.lower.x && columns_.near <= box.upper.y &&
         columns_.far >= box.lower.y && height_.near <= box.upper.z && height_.far >= box.lower.z;
}

}  // namespace riffler
