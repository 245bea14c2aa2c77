// A surface for picking: finds the point under a mouse, tablet or pen.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/marching/surface_hit.hpp"

namespace riffler::marching {

class Facets;
class Lattice;

/// A mesher's surface at one time, for picking only. Shares unchanged bricks with the mesher and with its other frozen
/// surfaces, and may outlive the mesher. Several threads may read it at once.
class FrozenSurface {
 public:
  using Bricks = std::vector<std::shared_ptr<const Facets>>;  // null for bricks without triangles
  /// `bricks` by number.
  FrozenSurface(const Lattice& lattice, Bricks bricks);

  /// Same as Mesher::pick.
  std::optional<SurfaceHit> pick(const Vec3& origin, const Vec3& direction, PickStats& stats) const;
  /// Number of triangles.
  std::size_t triangles() const;
  /// Bytes of its triangles, including those shared with other surfaces.
  std::size_t nbytes() const;

 private:
  std::shared_ptr<const Lattice> lattice_;
  Bricks bricks_;
};

}  // namespace riffler::marching
