// Checks whether a mesh bounds a solid.
#pragma once

#include <cstddef>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::mesh {

/// Counts of defects. The mesh is a closed, consistently oriented two-manifold if all but `components` and `volume` are
/// zero. Triangles that name a vertex twice count as degenerate and are otherwise ignored. Vertices are distinguished
/// by index, except at open edges, where vertices a few ulps apart count as one.
struct Audit {
  std::size_t open_edges = 0;            ///< edges used by one triangle
  std::size_t nonmanifold_edges = 0;     ///< edges used by three or more triangles, or by two in the same direction
  std::size_t nonmanifold_vertices = 0;  ///< vertices whose triangles do not form one closed or open fan: several fans,
                                         ///< or three or more triangles at an edge
  std::size_t degenerate = 0;            ///< triangles that name a vertex twice or have an area of exactly 0 in double
  std::size_t duplicates = 0;            ///< triangles with the same three vertices as an earlier one, in any order
  std::size_t folds = 0;       ///< edges between two well-oriented triangles that lie on each other: n1 · n2 < -0.99999
  std::size_t components = 0;  ///< pieces connected across edges; a shared vertex alone does not connect
  double volume = 0;           ///< mm³, signed

  /// Whether the mesh is a closed, oriented two-manifold.
  bool watertight() const { return open_edges + nonmanifold_edges + nonmanifold_vertices == 0; }
};

/// Counts the defects of `mesh`. Throws std::invalid_argument if `validate` does.
Audit audit(const Mesh& mesh, const Progress& progress = {});

}  // namespace riffler::mesh
