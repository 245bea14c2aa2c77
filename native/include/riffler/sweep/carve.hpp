// Carving: moves a tool along poses and removes the material that it sweeps.
#pragma once

#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/geom/rolled_pose.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// Carves poses.size() − 1 moves with the cutter over its full length; shank and holder never cut. With CarveMode::Add
/// it adds material, within the volume's box only. Returns the removed volume, force and torque of each move. Throws
/// std::invalid_argument naming the row for poses that are not finite, axes whose length differs from 1 by 1e-6 or
/// more, and exactly opposite axes; also for a tolerance or dt that is not positive, or a `protect` on another grid.
/// Cancelled leaves the volume unchanged.
Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options = {});

/// Carves with a hand tool (hand_tools.hpp): its frame turns between two poses by the shortest rotation at constant
/// rate. Throws as the other one does, also for a forward vector that is not of length 1 or not square to the axis
/// within 1e-6, for two poses that are a half turn apart, and for a tool of revolution; that one throws for hand tools.
Cut carve(Volume& volume, const Tool& tool, std::span<const RolledPose> poses, const CarveOptions& options = {});

/// Make the checks of `carve`: of the poses, and of the options for this many moves. Throw as `carve` does.
void check_path(std::span<const Pose> poses);
void check_path(std::span<const RolledPose> poses);
void check_options(const CarveOptions& options, std::size_t moves);
/// Throws if a hand tool is given poses without a roll, or another tool poses with one; numbers of rows.
void check_poses_suit(const Tool& tool, std::size_t plain, std::size_t rolled);

}  // namespace riffler::sweep
