// Removes the vertices inside planes before edges are queued.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// What a pass over a mesh's planes did.
struct FlatPass {
  double moved = 0;         // mm, the largest distance of a point from its place afterwards, in both directions
  std::vector<int> source;  // vertex now → vertex before
};

/// Takes the vertices inside planes out of a valid mesh: most of what a volume's mesh has. That needs no queue, no
/// costs and no traces, so it takes a fraction of the time. Edges and corners of planes stay, as do all vertices
/// elsewhere. Triangles and vertices keep their order; vertices without triangles go. The bytes are the same for any
/// number of threads.
///
/// A vertex may be `slack` (mm) from its plane: see FlatBrick for what that moves, at most kFlatTurns times.
FlatPass remove_inside_planes(Mesh& mesh, double slack, const Progress& progress = {});

inline constexpr int kFlatTurns = 3;

}  // namespace riffler::mesh
