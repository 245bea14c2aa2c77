// When two triangles are as good as folded onto each other.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::mesh {

/// Neighbours may not come nearer to lying on each other than 154°; an audit counts a cosine of -0.99999 as a fold.
inline constexpr double kFold = -0.9;

/// Whether the cosine of the angle between two normals, of any length, is below kFold; never for one of length 0.
inline bool opposed(const Vec3& a, const Vec3& b) {
  const double dot = glm::dot(a, b);
  return dot < 0 && dot * dot > kFold * kFold * glm::dot(a, a) * glm::dot(b, b);
}

}  // namespace riffler::mesh
