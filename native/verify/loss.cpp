#include "verify/loss.hpp"

#include <utility>

namespace riffler::verify {

namespace {

/// The position in the grid of a ray of the slab's tile k.
std::pair<int, int> ray_at(const Slab& slab, std::size_t k, int ray) {
  const auto across = static_cast<std::size_t>(slab.v1 - slab.v0);
  return {(slab.u0 + static_cast<int>(k / across)) * dexel::kTileSide + ray / dexel::kTileSide,
          (slab.v0 + static_cast<int>(k % across)) * dexel::kTileSide + ray % dexel::kTileSide};
}

}  // namespace

Vec3 on_ray(const dexel::Grid& grid, const Slab& slab, std::size_t k, int ray, double w) {
  const auto [i, j] = ray_at(slab, k, ray);
  return to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), w));
}

Loss loss_of(const dexel::Grid& grid, const Slab& slab, const SlabTiles& before, const SlabTiles& after) {
  Loss loss;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] == after[k]) continue;
    for_each_loss(*before[k], *after[k], [&](int ray, double near, double far) {
      const auto [i, j] = ray_at(slab, k, ray);
      loss.volume += (far - near) * grid.area(i, j);
      if (!(far - near > loss.longest)) return;
      loss.longest = far - near;
      loss.point = on_ray(grid, slab, k, ray, (near + far) / 2);
    });
  }
  return loss;
}

}  // namespace riffler::verify
