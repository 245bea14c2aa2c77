// Carving: moves a tool along poses and removes the material that it sweeps.
#pragma once

#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// Carves poses.size() − 1 moves with the cutter over its full length; shank and holder never cut. With CarveMode::Add
/// it adds material, within the volume's box only. Returns the removed volume, force and torque of each move. Throws
/// std::invalid_argument naming the row for poses that are not finite, axes whose length differs from 1 by 1e-6 or
/// more, and exactly opposite axes; also for a tolerance or dt that is not positive, or a `protect` on another grid.
/// Cancelled leaves the volume unchanged.
Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options = {});

/// Make the checks of `carve`: of the poses, and of the options for this many moves. Throw as `carve` does.
void check_path(std::span<const Pose> poses);
void check_options(const CarveOptions& options, std::size_t moves);

}  // namespace riffler::sweep
