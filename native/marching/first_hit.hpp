// The first triangle of a brick's facets that a ray meets.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>

#include "marching/lattice.hpp"
#include "riffler/marching/surface_hit.hpp"

namespace riffler::marching {

class Facets;

/// Looks at the bricks that the ray comes through. `facets`: those of a brick by its number, null where it has none;
/// asked only for bricks whose triangles the ray may meet.
using FacetsOf = std::function<const Facets*(std::size_t brick)>;
std::optional<SurfaceHit> first_hit(const Lattice& lattice, const Vec3& origin, const Vec3& direction,
                                    const FacetsOf& facets, PickStats& stats);

}  // namespace riffler::marching
