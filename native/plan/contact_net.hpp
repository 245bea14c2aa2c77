// The net of contact points over a part, and which of them a ball cannot reach.
#pragma once

#include <vector>

#include "plan/rolling_ball.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::plan {

/// A point of the part where a ball that is tangent there enters the part elsewhere.
struct Unreached {
  Vec3 point, normal;
  double depth;  ///< how far that ball enters, mm
  int triangle;
  double area;  ///< mm² for which it stands
};

struct ContactNet {
  std::vector<Unreached> points;  ///< in the order of the triangles
  std::size_t balls = 0;          ///< balls that were tried
};

/// Tries balls tangent to every triangle, or to parts of it down to `spacing` (mm) where neither all balls of the part
/// fit nor all of them enter: how many are tried follows the length of the border between the two. `depth` (mm): what a
/// ball may enter, or rise above a triangle, without counting. `angle` (rad): of a valley, at least. Where a ball
/// enters only what is turned by less than that there is none: at a valley's contact, one of the triangles at the other
/// contact is turned by at least the angle between the two.
ContactNet contact_net(const Mesh& part, const RollingBall& ball, double spacing, double depth, double angle,
                       const Progress& progress = {});

}  // namespace riffler::plan
