// Lengths of vectors and angles between them.
#pragma once

#include "base/functions.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// v scaled to length 1; the zero vector stays zero.
inline Vec3 unit_or_zero(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : Vec3(0);
}

/// Angle in rad between vectors of any length but 0. Accurate for angles from 1e-12 up to π.
inline double angle_between(const Vec3& a, const Vec3& b) {
  return base::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace riffler::geom
