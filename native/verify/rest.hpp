// Rest material: what stands on the part.
#pragma once

#include "riffler/base/progress.hpp"
#include "verify/gouge.hpp"

namespace riffler::verify {

/// The highest end of a span over the part's surface that is more than `tolerance` (mm) from it, and how high it is;
/// height 0 where there is none. Ends of all grids are looked at: a mesh cuts off the tips of cusps.
struct Rest {
  double height = 0;
  Vec3 point{0};
};
Rest rest_on(const Target& target, const Volume& left, double tolerance, const Progress& progress = {});

}  // namespace riffler::verify
