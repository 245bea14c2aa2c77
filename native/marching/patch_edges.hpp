// The edges of a patch, for programs that draw it.
#pragma once

#include "riffler/marching/patch.hpp"

namespace riffler::marching {

using Vec2i = glm::ivec2;

/// Every edge once, in the order in which the triangles' corners reach it, from corner k to corner k + 1.
struct PatchEdges {
  base::BulkVector<Vec2i> vertices;
  mesh::Triangles of_corner;  ///< (triangles, 3): edge between corners k and k + 1 (mod 3)
};

PatchEdges edges_of(const MeshPatch& patch);

}  // namespace riffler::marching
