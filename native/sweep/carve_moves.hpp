// Carves single moves on one grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"
#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Carves single moves on one grid, for callers that simulate parts of a volume themselves: move k goes from
/// poses[ends[k] − 1] to poses[ends[k]]. The resulting grid is bit-identical to `carve` with the same moves. Returns
/// the volume removed from this grid's rays, mm³ per move. The caller must call check_path before and give the volume a
/// new revision afterwards.
std::vector<double> carve_moves(dexel::Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                                std::span<const std::uint32_t> ends, double tolerance, dexel::Stats& stats);

}  // namespace riffler::sweep
