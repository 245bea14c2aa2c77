// Finds where columns pass through the openings of a broken part: the surfaces on which the boundary's part K of the
// winding number (field.hpp) is an odd multiple of ½.
#pragma once

#include <vector>

#include "dexel/from_mesh/crossings.hpp"
#include "dexel/from_mesh/passage.hpp"
#include "riffler/base/progress.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/mesh/mesh.hpp"

namespace riffler::dexel {

/// All passages of the grid's columns, sorted by row, column and z. `loops` is the mesh's boundary.
std::vector<Passage> find_passages(const Mesh& mesh, const std::vector<std::vector<int>>& loops,
                                   const Projection& projection, const Grid& grid, const Progress& progress = {});

/// K on the column (row, column) at z (mm), summed edge by edge with the same decisions as Projection makes, so that n
/// + K is exactly the winding number. Slow: use it for columns whose passages and crossings do not sum to zero.
double boundary_winding(const std::vector<std::vector<int>>& loops, const Projection& projection, double pitch, int row,
                        int column, double z);

}  // namespace riffler::dexel
