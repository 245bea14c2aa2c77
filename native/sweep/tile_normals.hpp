// Computes the normals of the ends that cuts have left in an open tile.
#pragma once

#include <cstddef>
#include <span>

#include "riffler/dexel/grid.hpp"
#include "sweep/open_tile.hpp"
#include "sweep/steps.hpp"

namespace riffler::sweep {

/// Stores all normals of an open tile, number `tile` of the grid. `steps` are those that have cut it since it was
/// opened.
void store_normals(OpenTile& rays, const dexel::Grid& grid, std::size_t tile, std::span<const Step> steps);

}  // namespace riffler::sweep
