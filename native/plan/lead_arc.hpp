// Arcs that lead the tool tangentially into a cut, or, reversed, out of it.
#pragma once

#include <vector>

#include "base/functions.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::plan {

/// Number of moves of an arc.
inline constexpr int kArcMoves = 8;

/// The points of an arc that ends in `p` in the direction `along`, without `p`: `turn` rad of a circle with the radius
/// `radius` (mm), with its centre on the side `aside` of `p`. `along` and `aside` are unit vectors, perpendicular to
/// each other.
inline std::vector<Vec3> lead_arc(const Vec3& p, const Vec3& along, const Vec3& aside, double radius, double turn) {
  std::vector<Vec3> out;
  for (int k = kArcMoves; k >= 1; --k) {
    const double angle = turn * k / kArcMoves;
    out.push_back(p + radius * ((1 - base::cos(angle)) * aside - base::sin(angle) * along));
  }
  return out;
}

}  // namespace riffler::plan
