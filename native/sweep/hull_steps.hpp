// Splits a move of a hand tool into steps.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "riffler/geom/rolled_pose.hpp"
#include "riffler/tool/hull.hpp"
#include "sweep/steps.hpp"

namespace riffler::sweep {

/// A pose in the cyclic frame of a grid whose rays run along `axis`, as `to_local` of a Pose.
RolledPose to_local(Axis axis, const RolledPose& p);

/// Calls `sink`, in order of t, for every step of the bodies on `motion` that can touch `box`. Poses, box and steps are
/// in the cyclic frame of one grid; bodies and motion must outlive the steps. A turning move is divided until the
/// heights over all faces, taken as linear in time, are right within a share of `tolerance` (mm).
void for_each_step(std::span<const tool::Hull> hulls, const RolledMotion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink);

}  // namespace riffler::sweep
