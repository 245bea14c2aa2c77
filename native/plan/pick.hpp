// Picks the point of a path that a pen or mouse points at.
#pragma once

#include "riffler/plan/path.hpp"

namespace riffler::plan {

/// A cutter contact point of a path.
struct Picked {
  std::size_t index;  ///< index of the path's point
  int side;           ///< index of the contact: 0 or 1
  double distance;    ///< distance from the point or ray, mm
  Vec3 point, normal;
};

/// The contact nearest to `p` (mm), the first of equals. Throws std::invalid_argument for an empty path or a point that
/// is not finite.
Picked nearest_contact(const PencilPath& path, const Vec3& p);
/// The contact nearest to the ray from `origin` (mm) in `direction` (any length but 0). For a contact behind the
/// origin, the distance from the origin counts. Errors as above, and for a zero direction.
Picked nearest_contact(const PencilPath& path, const Vec3& origin, const Vec3& direction);

}  // namespace riffler::plan
