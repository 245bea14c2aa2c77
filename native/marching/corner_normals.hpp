// Normals at a patch's corners, computed on the whole mesh.
#pragma once

#include "riffler/marching/patch.hpp"

namespace riffler::marching {

struct MeshState;

/// For each corner of each triangle of a patch of the state: the mean normal of the triangles around its vertex
/// whose normals are within `sharp` (rad) of the triangle's own, weighted by their angles there. Unit, world frame.
/// Triangles of other bricks count, too, so two patches have the same normals where they meet, up to rounding.
base::BulkVector<Vec3f> corner_normals(const MeshState& state, const MeshPatch& patch, double sharp);

}  // namespace riffler::marching
