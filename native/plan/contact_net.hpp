// The net of contact points over a part, and the points that a ball cannot reach.
#pragma once

#include <vector>

#include "plan/rolling_ball.hpp"
#include "riffler/base/progress.hpp"

namespace riffler::plan {

/// A point of the part whose tangent ball enters the part elsewhere.
struct Unreached {
  Vec3 point, normal;
  double depth;  ///< how far that ball enters the part, mm
  int triangle;
  double area;  ///< area that the point represents, mm²
};

struct ContactNet {
  std::vector<Unreached> points;  ///< in triangle order
  std::size_t balls = 0;          ///< balls tested
};

/// Tests balls tangent to every triangle, or to pieces of it down to `spacing` (mm) where some balls of a piece fit and
/// others enter: the number of tests grows with the length of the border between the two. `depth` (mm): tolerance by
/// which a ball may enter, or rise above a triangle. `angle` (rad): smallest angle of a valley. A ball that enters only
/// triangles turned by less than that is in no valley: at a valley's contact, one of the triangles at the other contact
/// is turned by at least the angle between the two.
ContactNet contact_net(const Mesh& part, const RollingBall& ball, double spacing, double depth, double angle,
                       const Progress& progress = {});

}  // namespace riffler::plan
