// A cell of a tessellation as a polygon with vertices on its sides, and its triangles.
#pragma once

#include <vector>

#include "riffler/mesh/mesh.hpp"

namespace riffler::nurbs {

/// A vertex of a cell's border, counter-clockwise in (u, v).
struct CornerOfCell {
  int vertex = 0;      // index in the mesh
  unsigned sides = 0;  // bit k: it lies on side k of the cell. Corners lie on two, poles on three
};

/// Appends the triangles of a cell. Neighbours in `polygon` that are one vertex become one, and no triangle has its
/// three corners on one side. Diagonals are as short as possible. `polygon` is used up.
void append_triangles(std::vector<CornerOfCell>& polygon, const mesh::Vertices& vertices,
                      std::vector<Vec3i>& triangles);

}  // namespace riffler::nurbs
