// Carving: a tool moves along poses and takes away what it sweeps.
#pragma once

#include <span>
#include <vector>

#include "dexel/volume.hpp"
#include "geom/pose.hpp"
#include "sweep/carve_options.hpp"
#include "sweep/convex_group.hpp"
#include "tool/tool.hpp"

namespace riffler::sweep {

/// Carves poses.size() − 1 moves with the cutter over its full length; shank and holder never cut. Throws
/// std::invalid_argument naming the row for poses that are not finite, axes whose length differs from 1 by 1e-6 or
/// more, exactly opposite axes, a tolerance or dt that is not positive, protect on another grid. Cancelled leaves the
/// volume unchanged. Material is put on within the volume's box only.
Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options = {});

/// Throw as `carve` does for poses that make no path, for options of so many moves.
void check_path(std::span<const Pose> poses);
void check_options(const CarveOptions& options, std::size_t moves);

/// Single moves on one grid, for those who simulate parts of a volume by themselves: move k goes from
/// poses[ends[k] − 1] to poses[ends[k]]. What is left is, bit for bit, what `carve` leaves of the same moves. Returns
/// mm³ of this grid's rays per move. The caller has called check_path, and gives the volume a fresh revision.
std::vector<double> carve_moves(dexel::Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                                std::span<const std::uint32_t> ends, double tolerance, dexel::Stats& stats);

}  // namespace riffler::sweep
