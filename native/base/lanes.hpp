// How many values a kernel looks at together.
#pragma once

namespace riffler::base {

/// Rays, points and triangles are handled in groups of up to this many, the most doubles that a vector holds; arrays
/// are padded by as much.
inline constexpr int kLanes = 8;

}  // namespace riffler::base
