// Carving: a tool moves along poses and takes away what it sweeps.
#pragma once

#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::sweep {

/// Carves poses.size() − 1 moves with the cutter over its full length; shank and holder never cut. Throws
/// std::invalid_argument naming the row for poses that are not finite, axes whose length differs from 1 by 1e-6 or
/// more, exactly opposite axes, a tolerance or dt that is not positive, protect on another grid. Cancelled leaves the
/// volume unchanged. Material is put on within the volume's box only.
Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options = {});

/// Throw as `carve` does for poses that make no path, for options of so many moves.
void check_path(std::span<const Pose> poses);
void check_options(const CarveOptions& options, std::size_t moves);

}  // namespace riffler::sweep
