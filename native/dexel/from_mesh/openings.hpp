// Where columns pass through the openings of a broken part: the surfaces on which its boundary's share K of the winding
// number (field.hpp) is an odd multiple of ½.
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

/// K on the column (row, column) at z (mm), edge by edge, with every decision as in Projection: n + K is the winding
/// number itself. Slow: for columns on which passages and crossings do not sum to zero.
double boundary_winding(const std::vector<std::vector<int>>& loops, const Projection& projection, double pitch, int row,
                        int column, double z);

}  // namespace riffler::dexel
