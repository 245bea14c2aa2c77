// Where a ray first meets the surface: what a mouse, a tablet or a pen points at.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "geom/vec.hpp"
#include "marching/lattice.hpp"

namespace riffler::marching {

class Facets;

/// The first point of a surface along a ray.
struct SurfaceHit {
  double distance;  ///< mm from the ray's origin
  Vec3 point;
  Vec3 normal;        ///< unit, of the triangle there, out of the material: along the ray where it comes from inside
  std::size_t brick;  ///< whose triangle it is
};

/// What picking took.
struct PickStats {
  std::uint64_t rays = 0;
  std::uint64_t bricks_visited = 0;    ///< (brick, ray) pairs whose triangles were looked for
  std::uint64_t bricks_prepared = 0;   ///< bricks whose triangles were made ready: those that had changed
  std::uint64_t triangles_tested = 0;  ///< (triangle, ray) pairs
};

/// A mesher's surface as it was at one time, to be picked only. Shares with the mesher, and with other surfaces of it,
/// the bricks that did not change in between; goes on when the mesher has gone. May be read from several threads.
class FrozenSurface {
 public:
  using Bricks = std::vector<std::shared_ptr<const Facets>>;  // null for bricks without triangles
  FrozenSurface(const Lattice& lattice, Bricks bricks) : lattice_(lattice), bricks_(std::move(bricks)) {}

  /// As Mesher::pick.
  std::optional<SurfaceHit> pick(const Vec3& origin, const Vec3& direction, PickStats& stats) const;
  std::size_t triangles() const;
  /// Of its triangles, whoever shares them.
  std::size_t nbytes() const;

 private:
  Lattice lattice_;
  Bricks bricks_;
};

/// Looks at the bricks that the ray comes through. `facets`: those of a brick by its number, null where it has none;
/// asked only for bricks whose triangles the ray may meet.
using FacetsOf = std::function<const Facets*(std::size_t brick)>;
std::optional<SurfaceHit> first_hit(const Lattice& lattice, const Vec3& origin, const Vec3& direction,
                                    const FacetsOf& facets, PickStats& stats);

}  // namespace riffler::marching
