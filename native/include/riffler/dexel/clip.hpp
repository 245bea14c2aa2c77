// Cuts a volume with a plane.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Removes the material in front of the plane through `point` (mm); `normal` (any length but 0) points to the front and
/// becomes the outward normal of the cut. Every new span end is the exact crossing of ray and plane. Throws
/// std::invalid_argument if a vector is not finite or the normal has length 0.
void clip(Volume& volume, const Vec3& point, const Vec3& normal, const Progress& progress = {});

}  // namespace riffler::dexel
