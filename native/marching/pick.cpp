#include "riffler/marching/pick.hpp"

#include <utility>

#include "marching/facets.hpp"
#include "marching/first_hit.hpp"

namespace riffler::marching {

FrozenSurface::FrozenSurface(const Lattice& lattice, Bricks bricks)
    : lattice_(std::make_shared<const Lattice>(lattice)), bricks_(std::move(bricks)) {}

std::optional<SurfaceHit> FrozenSurface::pick(const Vec3& origin, const Vec3& direction, PickStats& stats) const {
  return first_hit(*lattice_, origin, direction, [&](std::size_t n) { return bricks_[n].get(); }, stats);
}

std::size_t FrozenSurface::triangles() const {
  std::size_t sum = 0;
  for (const auto& brick : bricks_) sum += brick ? brick->triangles() : 0;
  return sum;
}

std::size_t FrozenSurface::nbytes() const {
  std::size_t sum = bricks_.size() * sizeof(bricks_[0]);
  for (const auto& brick : bricks_) sum += brick ? brick->nbytes() : 0;
  return sum;
}

}  // namespace riffler::marching
