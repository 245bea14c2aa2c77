// A convex polytope on a short part of a move, as plain numbers for the kernel.
#pragma once

#include <cstddef>

#include "riffler/base/block_pool.hpp"
#include "riffler/geom/rolled_pose.hpp"
#include "riffler/geom/vec.hpp"
#include "riffler/tool/hull.hpp"

namespace riffler::sweep {

/// One step of a hand tool's body. `error` (mm): what `HullBody` deviates by at most, in space, between t0 and t1.
struct HullPart {
  const tool::Hull* hull;
  const RolledMotion* motion;
  double t0, t1, error;
  double reach;      ///< mm, largest distance of a corner from the line through the tip about which the body turns
  double tolerance;  ///< mm, of the carve
};

/// Signed height of a point over one face, positive outside, at both poses of a part: (u, v, s) · at[pose] − off[pose],
/// with coordinates from the tip at the start.
struct HullFace {
  double at[2][3], off[2];
  /// 1 / slope along the ray at each pose; 0 if the face is parallel to the rays.
  double inverse[2];
};

/// The swept body of a convex polytope between two poses. The height over each face is taken as linear in time between
/// its exact values at both poses: f = (1 − τ) f0 + τ f1, 0 ≤ τ ≤ 1, where f0 and f1 are linear along a ray. For a
/// fixed s the times with all f ≤ 0 are an interval, and for a fixed τ the heights s are one (methods: "Hand tools").
/// Straight moves are exact.
struct HullBody {
  /// `box`: where the rays run, in the grid's frame. The body is right only in it, because faces that have all of it on
  /// their inner side at both poses are left out.
  HullBody(const HullPart& part, const Box3& box);

  bool beside = false;  ///< whether one face has all of the box on its outer side at both poses: nothing is swept
  base::BlockVector<HullFace> faces;
  mutable base::BlockVector<double> heights;  ///< room for the kernel: f0 and f1 of each face at s = 0
  double tip[3], way[3];                      ///< at the start, and its displacement during the part
  double moved, angle;                        ///< length of the displacement; rad, of the turn
  double slack;   ///< mm, what counts as rounding: points no farther outside than this lie inside
  double nearby;  ///< mm, steps along a ray that are no progress
  bool narrow;    ///< whether what lies between two swept points of a ray is swept within a share of the tolerance
  HullPart part;
  Box3 box;

 private:
  bool add(const HullFace& face);
};

}  // namespace riffler::sweep
