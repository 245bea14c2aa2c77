// The point of a path that a pen or a mouse points at.
#pragma once

#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// A cutter contact point of a path.
struct Picked {
  std::size_t index;  ///< of the path's point
  int side;           ///< which of its two contacts
  double distance;    ///< mm
  Vec3 point, normal;
};

/// The contact nearest to `p`, the first of equals. std::invalid_argument for an empty path or a point that is not
/// finite.
Picked nearest_contact(const PencilPath& path, const Vec3& p);
/// The contact nearest to the ray from `origin` in `direction` (of any length but 0); one behind the origin is as far
/// as from the origin.
Picked nearest_contact(const PencilPath& path, const Vec3& origin, const Vec3& direction);

}  // namespace riffler::plan
