// Finds the first triangle of the bricks' facets that a ray meets.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "marching/lattice.hpp"
#include "riffler/marching/surface_hit.hpp"

namespace riffler::marching {

class Facets;

/// Tests the bricks along the ray. `facets` returns the facets of a brick by its number, null if it has none; it is
/// called only for bricks whose triangles the ray may meet.
using FacetsOf = std::function<const Facets*(std::size_t brick)>;
std::optional<SurfaceHit> first_hit(const Lattice& lattice, const Vec3& origin, const Vec3& direction,
                                    const FacetsOf& facets, PickStats& stats);

}  // namespace riffler::marching
