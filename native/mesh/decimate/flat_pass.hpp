// Removes the vertices inside planes, and some of those on curves, before edges are queued.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Result of a pass over a mesh's planes.
struct FlatPass {
  double moved = 0;         // mm, the largest distance between the old and the new surface, in both directions
  std::vector<int> source;  // vertex now → vertex before
};

/// Removes the vertices inside planes from a valid mesh; most vertices of a volume's mesh are such. This needs no
/// queue, no costs and no traces, so it takes a fraction of the time. Edges and corners of planes stay. Triangles and
/// vertices keep their order; vertices without triangles are removed. The bytes are the same for any number of threads.
///
/// A vertex may be `slack` (mm) from its plane. FlatBrick says how far that moves points, in each of at most kFlatTurns
/// turns.
///
/// `curved`: mm; if positive, the first turn also merges vertices of curves whose surface moves by no more than that.
FlatPass remove_inside_planes(Mesh& mesh, double slack, double curved, const Progress& progress = {});

inline constexpr int kFlatTurns = 3;

}  // namespace riffler::mesh
