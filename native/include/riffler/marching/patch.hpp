// Part of a mesh, with numbers of its own.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::marching {

/// The part of a mesh in some bricks of 32 × 32 × 32 cells: their own vertices, then those of other bricks that their
/// triangles touch. World frame. What two patches share has the same coordinates in both, bit for bit, and no other
/// vertices of a mesh have.
struct MeshPatch {
  base::BulkVector<Vec3f> vertices;
  mesh::Triangles triangles;
  std::size_t own = 0;                ///< vertices that are the bricks' own
  std::vector<std::size_t> bricks;    ///< those of them that have triangles, in order
  std::vector<std::int32_t> foreign;  ///< the others' numbers in the whole mesh, ascending
};

struct MeshState;
/// As Mesher::patch.
MeshPatch patch_of(const MeshState& state, std::span<const std::size_t> bricks);

}  // namespace riffler::marching
