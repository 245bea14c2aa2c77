// Normals of what a convex part of a tool sweeps.
#pragma once

#include <span>

#include "riffler/geom/pose.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Unit normal, out of a convex group, where its sweep along `motion` has its boundary at p at time t; p may be off by
/// a tolerance. mm, in the frame of the motion.
Vec3 swept_normal(std::span<const PieceShape> group, const Motion& motion, const Vec3& p, double t);

}  // namespace riffler::sweep
