// Crossings of triangles with the rays of a grid, several triangles at a time in vector lanes, chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "dexel/from_mesh/crossings.hpp"

namespace riffler::dexel {

/// Appends the crossings of some triangles with rows first ≤ row < last to `out`, in an order that depends on the
/// registers' width.
void find_crossings(std::span<const Vec3i> corners, std::span<const std::uint32_t> triangles,
                    const Projection& projection, int first, int last, BandCrossings& out);

}  // namespace riffler::dexel
