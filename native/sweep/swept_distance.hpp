// Distance of a point from the body that a moving cutter sweeps.
#pragma once

#include "riffler/geom/pose.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::sweep {

/// Least signed distance (mm, negative inside) of `p` from the cutter during the motion, within `slack` (mm) above it.
/// Where it exceeds `enough`, any value above that may be returned.
///
/// Branch and bound over the time: a material point at `p` moves at most `speed` per unit of time, and the distance
/// from a solid is 1-Lipschitz. Exact for every cutter and motion, and independent of the kernels that cut.
double swept_distance(const tool::Outline& cutter, const Motion& motion, const Vec3& p, double enough, double slack);

}  // namespace riffler::sweep
