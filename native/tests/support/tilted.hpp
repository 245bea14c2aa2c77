// Tool axes by angles.
#pragma once

#include <cmath>

#include "geom/math.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::test {

/// Axis at `tilt` from z towards the azimuth `around`, degrees.
inline Vec3 tilted(double tilt, double around) {
  return {std::sin(tilt * kDegree) * std::cos(around * kDegree), std::sin(tilt * kDegree) * std::sin(around * kDegree),
          std::cos(tilt * kDegree)};
}

}  // namespace riffler::test
