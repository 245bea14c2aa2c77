// Part of a mesh with its own vertex numbers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::marching {

/// The part of a mesh in some bricks of 32 × 32 × 32 cells: first the bricks' own vertices, then the vertices of other
/// bricks that their triangles use. World frame, mm. A vertex shared by two patches has the same coordinates in both,
/// bit for bit; no other two vertices of a mesh have equal coordinates.
struct MeshPatch {
  base::BulkVector<Vec3f> vertices;
  mesh::Triangles triangles;
  std::size_t own = 0;                ///< number of vertices that belong to the bricks themselves
  std::vector<std::size_t> bricks;    ///< the requested bricks that have triangles, in order
  std::vector<std::int32_t> foreign;  ///< numbers in the mesher's full mesh of the other bricks' vertices, ascending
  std::vector<std::int32_t> numbers;  ///< of a mesher with a tolerance: the same of all vertices
};

struct MeshState;
/// Same as Mesher::patch.
MeshPatch patch_of(const MeshState& state, std::span<const std::size_t> bricks);

}  // namespace riffler::marching
