// Distances from a hand tool's motion, by the dense reference.
#pragma once

#include <span>
#include <vector>

#include "riffler/geom/rolled_pose.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::bench {

/// Signed distances (mm) of points from the tool at poses that lie densely in time: no corner moves farther than `step`
/// (mm) between two. Above 1 mm, any value above it.
std::vector<double> hull_distances(const Tool& tool, std::span<const RolledPose> poses, double step,
                                   std::span<const Vec3> points);

}  // namespace riffler::bench
