// The smooth brush.
#pragma once

#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

struct SmoothOptions {
  /// mm, of the brush: what lies beyond it stays as it is.
  double radius = 5;
  /// 0 … 1: the share of the way to the smoothed surface, at the brush's centre.
  double strength = 0.5;
  /// What lies in it stays as it is, or null. Of the same frame as the volume, and not the volume itself.
  const Volume* protect = nullptr;
  Progress progress;
};

/// What each dab took away and put on, mm³, of the rays that define Volume::volume().
struct SmoothResult {
  std::vector<double> removed, added;
};

/// Smooths the surface of a tri-dexel volume by one dab after the other: places within the radius of a centre come
/// nearer to the plane that fits the surface within four pitches around them, never farther than one pitch. Planes stay
/// as they are, edges become round, noise is levelled. Material never leaves the box; tiles that nothing of was changed
/// stay shared. Throws std::invalid_argument for a volume of one direction, centres that are not finite (naming the
/// row), a radius that is not positive, a strength beyond 0 … 1, protect on another grid. Cancelled leaves the volume
/// unchanged.
SmoothResult smooth_dabs(Volume& volume, std::span<const Vec3> centres, const SmoothOptions& options = {});

}  // namespace riffler::dexel
