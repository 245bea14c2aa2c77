// Rounding to the coordinates that a binary STL holds.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// `x` rounded to float32. Use this, not a cast to float and back: GCC 12.2 at -O2 takes two neighbouring casts
/// double → float → double that pass through memory, as those of a GLM vector do, for no change at all (a fault of its
/// straight-line vectoriser). The volatile keeps it from seeing them together.
inline double to_float32(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}
inline Vec3 to_float32(const Vec3& v) {
  return {to_float32(v.x), to_float32(v.y), to_float32(v.z)};
}

}  // namespace riffler::geom
