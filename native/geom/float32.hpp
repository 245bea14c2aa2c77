// Rounding to the float32 coordinates of a binary STL.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// `x` rounded to float32. Use this instead of casting to float and back: the straight-line vectoriser of GCC 12.2 at
/// -O2 has a bug that drops two adjacent casts double → float → double through memory, as in a GLM vector. The volatile
/// variable hides the pair of casts from it.
inline double to_float32(double x) {
  const volatile float rounded = static_cast<float>(x);
  return static_cast<double>(rounded);
}
inline Vec3 to_float32(const Vec3& v) {
  return {to_float32(v.x), to_float32(v.y), to_float32(v.z)};
}

}  // namespace riffler::geom
