// Carving of single moves on one grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"
#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Single moves on one grid, for those who simulate parts of a volume by themselves: move k goes from
/// poses[ends[k] − 1] to poses[ends[k]]. What is left is, bit for bit, what `carve` leaves of the same moves. Returns
/// mm³ of this grid's rays per move. The caller has called check_path, and gives the volume a fresh revision.
std::vector<double> carve_moves(dexel::Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                                std::span<const std::uint32_t> ends, double tolerance, dexel::Stats& stats);

}  // namespace riffler::sweep
