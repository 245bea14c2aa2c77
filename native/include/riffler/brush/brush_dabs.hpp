// Brushes with falloff: clay, inflate, flatten, grab and others, on the material of a tri-dexel volume.
#pragma once

#include <span>

#include "riffler/brush/options.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::brush {

/// The effect of the dabs.
struct BrushResult {
  double removed = 0, added = 0;  ///< mm³, on the rays that define Volume::volume(); summed over the dabs
  double lost = 0;                ///< mm³ of walls thinner than the pitch that moved sideways by more than a pitch
  bool clipped = false;           ///< material has reached the volume's box and was cut off there
};

/// Displaces the surface of a tri-dexel volume, dab by dab. A dab's tip is its centre (mm), its axis a unit vector out
/// of the material. Nothing changes, to the bit, at more than `radius` from the centre; for Grab and SnakeHook, from
/// the line that the centre moves on. Where the surface is smooth, the result is within h² / 4 times its largest
/// curvature of the displaced surface, h the pitch; edges stay edges. Displaced parts that overlap unite. A brush
/// narrower than a pitch may miss every vertex, and then changes nothing. Material never leaves the box; unchanged
/// tiles stay shared. The same bytes for any number of threads. Throws std::invalid_argument for a volume of one
/// direction, dabs that are not finite or whose axis is not a unit vector (naming the row), a radius that is not
/// positive, a strength outside 0 … 1, an amount that is not finite, or a `protect` on another grid. Cancelled leaves
/// the volume unchanged.
BrushResult brush_dabs(Volume& volume, std::span<const Pose> dabs, const BrushOptions& options = {});

}  // namespace riffler::brush
