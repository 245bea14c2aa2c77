// Decides when two triangles are nearly folded onto each other.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// Lower limit of the cosine between the normals of neighbours: an angle of 154°. (An audit counts a fold below
/// -0.99999.)
inline constexpr double kFold = -0.9;

/// Whether the cosine of the angle between two normals of any length is below kFold; false if one has length 0.
inline bool opposed(const Vec3& a, const Vec3& b) {
  const double dot = glm::dot(a, b);
  return dot < 0 && dot * dot > kFold * kFold * glm::dot(a, a) * glm::dot(b, b);
}

}  // namespace riffler::mesh
