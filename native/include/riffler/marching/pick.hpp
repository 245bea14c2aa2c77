// A surface to be picked: what a mouse, a tablet or a pen points at.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/marching/surface_hit.hpp"

namespace riffler::marching {

class Facets;
class Lattice;

/// A mesher's surface as it was at one time, to be picked only. Shares with the mesher, and with other surfaces of it,
/// the bricks that did not change in between; goes on when the mesher has gone. May be read from several threads.
class FrozenSurface {
 public:
  using Bricks = std::vector<std::shared_ptr<const Facets>>;  // null for bricks without triangles
  FrozenSurface(const Lattice& lattice, Bricks bricks);

  /// As Mesher::pick.
  std::optional<SurfaceHit> pick(const Vec3& origin, const Vec3& direction, PickStats& stats) const;
  std::size_t triangles() const;
  /// Bytes of its triangles, those shared with others included.
  std::size_t nbytes() const;

 private:
  std::shared_ptr<const Lattice> lattice_;
  Bricks bricks_;
};

}  // namespace riffler::marching
