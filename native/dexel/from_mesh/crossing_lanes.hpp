// Intersects triangles with the rays of a grid, several triangles at a time in SIMD lanes selected at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dexel/from_mesh/crossings.hpp"

namespace riffler::dexel {

/// Appends to `out` the crossings of these triangles with the rows first ≤ row < last. Their order depends on the width
/// of the vectors.
void find_crossings(std::span<const Vec3i> corners, std::span<const std::uint32_t> triangles,
                    const Projection& projection, int first, int last, BandCrossings& out);

}  // namespace riffler::dexel
