// Number of values that a kernel handles together.
#pragma once

namespace riffler::base {

/// Kernels handle rays, points and triangles in groups of up to this many, the largest number of doubles in a vector.
/// Arrays are padded by as many elements.
inline constexpr int kLanes = 8;

}  // namespace riffler::base
