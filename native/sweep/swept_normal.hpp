// Normals of the swept volume of a convex part of a tool.
#pragma once

#include <span>

#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Unit outward normal of the volume that a convex group sweeps along `motion`, at its boundary point p, which arises
/// at time t. p may be inaccurate by a tolerance. mm, in the frame of the motion.
Vec3 swept_normal(std::span<const PieceShape> group, const Motion& motion, const Vec3& p, double t);

}  // namespace riffler::sweep
