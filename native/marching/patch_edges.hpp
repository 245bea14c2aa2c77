// The edges of a patch, as programs that draw it want them.
#pragma once

#include "riffler/marching/patch.hpp"

namespace riffler::marching {

using Vec2i = glm::ivec2;

/// Every edge once, in the order in which the triangles' corners come upon them, from corner k to corner k + 1.
struct PatchEdges {
  base::BulkVector<Vec2i> vertices;
  mesh::Triangles of_corner;  ///< (triangles, 3): the edge between corners k and k + 1 (mod 3)
};

PatchEdges edges_of(const MeshPatch& patch);

}  // namespace riffler::marching
