// Where the surface of a mesh ends: the directed edges that no neighbour takes back.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

struct Boundary {
  /// Closed walks: walk k visits the vertices loops[k][0], loops[k][1], … and returns to the first. Every directed edge
  /// stands as often as triangles run through it that way less those that run against it, so a closed mesh has none,
  /// and with surfaces that close the walks the mesh is closed. Vertices with equal coordinates count as one.
  std::vector<std::vector<int>> loops;
  /// Vertices and the one with their coordinates that stands for them in `loops`, if one does; of those alone at which
  /// triangles do not fit together by their indices.
  std::vector<std::pair<int, int>> twins;

  bool empty() const { return loops.empty(); }
};

/// O(n) for closed meshes.
Boundary find_boundary(const Mesh& mesh);

/// The mesh with cracks joined: of its boundary's vertices, each that lies within `tolerance` (mm) of one before it
/// moves there. What rounding tore apart is closed by this, so that no column has to look for its way between the lips.
/// Nothing where no vertex moves.
std::optional<Mesh> join_cracks(const Mesh& mesh, const Boundary& boundary, double tolerance);

}  // namespace riffler::dexel
