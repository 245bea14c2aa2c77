// Rest material: material left on the part.
#pragma once

#include "riffler/base/progress.hpp"
#include "verify/gouge.hpp"

namespace riffler::verify {

/// The span end highest above the part's surface that is more than `tolerance` (mm) from it, and its height; height 0
/// if there is none. Examines the span ends of all grids, because a mesh cuts off the tips of cusps.
struct Rest {
  double height = 0;
  Vec3 point{0};
};
Rest rest_on(const Target& target, const Volume& left, double tolerance, const Progress& progress = {});

}  // namespace riffler::verify
