// Lengths and angles of directions.
#pragma once

#include <cmath>

#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// As v, with length 1, or 0 where it has none.
inline Vec3 unit_or_zero(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : Vec3(0);
}

/// rad; of vectors of any length but 0, accurate for 1e-12 as for those near π.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace riffler::geom
