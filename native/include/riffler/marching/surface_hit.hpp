// Where a ray meets a surface.
#pragma once

#include <cstddef>
#include <cstdint>

#include "riffler/geom/vec.hpp"

namespace riffler::marching {

/// The first point of a surface along a ray.
struct SurfaceHit {
  double distance;  ///< mm from the ray's origin
  Vec3 point;
  Vec3 normal;        ///< unit normal of the triangle, out of the material: along the ray if the ray starts inside
  std::size_t brick;  ///< brick that the triangle belongs to
};

/// Counters of the work done by picking.
struct PickStats {
  std::uint64_t rays = 0;
  std::uint64_t bricks_visited = 0;    ///< (brick, ray) pairs whose triangles were searched
  std::uint64_t bricks_prepared = 0;   ///< bricks whose triangles were prepared because they had changed
  std::uint64_t triangles_tested = 0;  ///< (triangle, ray) pairs
};

}  // namespace riffler::marching
