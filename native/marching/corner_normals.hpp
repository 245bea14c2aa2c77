// Normals of a patch as they are on the whole mesh.
#pragma once

#include <span>

#include "riffler/marching/patch.hpp"

namespace riffler::marching {

struct MeshState;

/// For each corner of each triangle of `patch_of(state, bricks)` the mean normal of the triangles around its vertex,
/// weighted by their angles there, of those whose normals are within `sharp` (rad) of the triangle's own; unit, world
/// frame. Triangles of other bricks count, too: what two patches share has the same normals in both, but for rounding.
base::BulkVector<Vec3f> corner_normals(const MeshState& state, std::span<const std::size_t> bricks,
                                       const MeshPatch& patch, double sharp);

}  // namespace riffler::marching
