// A volume cut off by a plane.
#pragma once

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::dexel {

/// Takes away what lies in front of the plane through `point` (mm) with `normal`, any length but 0: what is left looks
/// out along it. Every end is the exact crossing of its ray. Throws std::invalid_argument for vectors that are not
/// finite and a normal of length 0.
void clip(Volume& volume, const Vec3& point, const Vec3& normal, const Progress& progress = {});

}  // namespace riffler::dexel
