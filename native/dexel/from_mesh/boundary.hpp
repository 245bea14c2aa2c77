// Finds where the surface of a mesh ends: the directed edges without an opposite neighbour.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

struct Boundary {
  /// Closed loops: loop k visits the vertices loops[k][0], loops[k][1], … and returns to the first. A directed edge
  /// appears as often as triangles run through it in its direction, minus those in the opposite direction. So a closed
  /// mesh has no loops, and surfaces that close the loops would close the mesh. Vertices with equal coordinates count
  /// as one.
  std::vector<std::vector<int>> loops;
  /// Pairs of a vertex and the vertex with equal coordinates that represents it in `loops`, if any. Only for vertices
  /// where triangles do not connect by their indices.
  std::vector<std::pair<int, int>> twins;

  bool empty() const { return loops.empty(); }
};

/// Finds the boundary; O(n) for closed meshes.
Boundary find_boundary(const Mesh& mesh);

/// Closes cracks: moves each boundary vertex onto an earlier one that lies within `tolerance` (mm). This joins what
/// rounding tore apart, so no ray has to be classified between the lips of a crack. Returns nothing if no vertex moves.
std::optional<Mesh> join_cracks(const Mesh& mesh, const Boundary& boundary, double tolerance);

}  // namespace riffler::dexel
