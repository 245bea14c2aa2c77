// What a mesh is worth as the surface of a solid.
#pragma once

#include <cstddef>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Counts of defects. All zero but `components` and `volume`: a closed, consistently oriented two-manifold.
/// Triangles that name a vertex twice are counted as degenerate and otherwise left out, as if they were removed.
/// Vertices are told apart by index, but where edges are open those a few ulps apart count as one.
struct Audit {
  std::size_t open_edges = 0;         ///< used by one triangle
  std::size_t nonmanifold_edges = 0;  ///< used by three or more, or by two that run it in the same direction
  std::size_t nonmanifold_vertices =
      0;                       ///< whose triangles are not one closed or open fan: joined across edges of just
                               ///< two triangles they fall apart, or three or more meet at an edge of theirs
  std::size_t degenerate = 0;  ///< triangles that name a vertex twice or whose area is exactly 0 in double
  std::size_t duplicates = 0;  ///< triangles whose three vertices an earlier one has, in whatever order
  std::size_t folds = 0;       ///< edges of two well-oriented triangles that lie on each other: n1 · n2 < -0.99999
  std::size_t components = 0;  ///< pieces connected across edges; touching at vertices does not connect
  double volume = 0;           ///< mm³, signed

  /// A closed, oriented two-manifold.
  bool watertight() const { return open_edges + nonmanifold_edges + nonmanifold_vertices == 0; }
};

/// std::invalid_argument where `validate` throws.
Audit audit(const Mesh& mesh, const Progress& progress = {});

}  // namespace riffler::mesh
