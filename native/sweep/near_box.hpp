// When a moving tool is within reach of a grid.
#pragma once

#include <algorithm>

#include "riffler/geom/interval.hpp"
#include "riffler/geom/pose.hpp"

namespace riffler::sweep {

/// The times at which a ball of `reach` (mm) about the tip meets the box. The rest of the move is skipped: at 90 km, a
/// micron is beyond double precision, and for a tool that only passes by, the rotation would be divided needlessly.
inline Interval near_box(double reach, const Motion& motion, const Box3& box) {
  Interval times{0, 1};
  const Vec3 from = motion.from().tip, way = motion.to().tip - from;
  for (int i = 0; i < 3; ++i) {
    const double low = box.lower[i] - reach - from[i], high = box.upper[i] + reach - from[i];
    if (way[i] == 0) {
      if (low > 0 || high < 0) return {};
      continue;
    }
    const double a = low / way[i], b = high / way[i];
    times = times.cut({std::min(a, b), std::max(a, b)});
  }
  return times;
}

}  // namespace riffler::sweep
