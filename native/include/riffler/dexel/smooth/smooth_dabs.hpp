// The smooth brush.
#pragma once

#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

struct SmoothOptions {
  /// Brush radius, mm. Material outside it does not change.
  double radius = 5;
  /// Blend factor at the brush centre: 0 unchanged, 1 fully smoothed.
  double strength = 0.5;
  /// Region that must not change; null for none. It has the volume's frame and is not the volume itself.
  const Volume* protect = nullptr;
  Progress progress;
};

/// Material that each dab removed and added, mm³, measured on the rays that define Volume::volume().
struct SmoothResult {
  std::vector<double> removed, added;
};

/// Smooths the surface of a tri-dexel volume, one dab after the other. Surface points within the radius of a centre
/// (mm) move towards the plane fitted to the surface within four pitches of them, by at most one pitch. Planes do not
/// change, edges become round, noise is levelled. Material never leaves the box; unchanged tiles stay shared. Throws
/// std::invalid_argument for a volume of one direction, centres that are not finite (naming the row), a radius that is
/// not positive, a strength outside 0 … 1, or a `protect` on another grid. Cancelled leaves the volume unchanged.
SmoothResult smooth_dabs(Volume& volume, std::span<const Vec3> centres, const SmoothOptions& options = {});

}  // namespace riffler::dexel
