// Material lost by a tile: the pieces of its spans that a later state no longer has.
#pragma once

#include "riffler/dexel/grid.hpp"
#include "verify/slab.hpp"

namespace riffler::verify {

/// Calls f(near, far) for every piece of `before` that is missing in `after`, upwards.
template <class F>
void for_each_loss_on_ray(std::span<const dexel::Span> before, std::span<const dexel::Span> after, const F& f) {
  std::size_t next = 0;
  for (const dexel::Span& s : before) {
    double from = s.near;
    while (next < after.size() && after[next].far <= from) ++next;
    for (std::size_t k = next; k < after.size() && after[k].near < s.far; ++k) {
      if (after[k].near > from) f(from, after[k].near);
      from = after[k].far;
    }
    if (from < s.far) f(from, s.far);
  }
}

/// Calls f(ray, near, far) for every such piece, ray by ray.
template <class F>
void for_each_loss(const dexel::Tile& before, const dexel::Tile& after, const F& f) {
  for (int r = 0; r < dexel::kTileRays; ++r)
    for_each_loss_on_ray(before.ray(r), after.ray(r), [&](double near, double far) { f(r, near, far); });
}

/// The total loss of a slab.
struct Loss {
  double volume = 0;   ///< mm³
  double longest = 0;  ///< mm along a ray
  Vec3 point{0};       ///< middle of the longest piece, world frame
};

/// World coordinates of a point on a ray of the slab's tile k.
Vec3 on_ray(const dexel::Grid& grid, const Slab& slab, std::size_t k, int ray, double w);

Loss loss_of(const dexel::Grid& grid, const Slab& slab, const SlabTiles& before, const SlabTiles& after);

}  // namespace riffler::verify
