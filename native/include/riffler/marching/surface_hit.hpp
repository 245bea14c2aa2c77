// What a ray meets of a surface.
#pragma once

#include <cstddef>
#include <cstdint>

#include "riffler/geom/vec.hpp"

namespace riffler::marching {

/// The first point of a surface along a ray.
struct SurfaceHit {
  double distance;  ///< mm from the ray's origin
  Vec3 point;
  Vec3 normal;        ///< unit, of the triangle there, out of the material: along the ray where it comes from inside
  std::size_t brick;  ///< whose triangle it is
};

/// What picking took.
struct PickStats {
  std::uint64_t rays = 0;
  std::uint64_t bricks_visited = 0;    ///< (brick, ray) pairs whose triangles were looked for
  std::uint64_t bricks_prepared = 0;   ///< bricks whose triangles were made ready: those that had changed
  std::uint64_t triangles_tested = 0;  ///< (triangle, ray) pairs
};

}  // namespace riffler::marching
