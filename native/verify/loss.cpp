#include "verify/loss.hpp"

namespace riffler {

Vec3 on_ray(const Grid& grid, const Slab& slab, std::size_t k, int ray, double w) {
  const auto across = static_cast<std::size_t>(slab.v1 - slab.v0);
  const int i = (slab.u0 + static_cast<int>(k / across)) * kTileSide + ray / kTileSide,
            j = (slab.v0 + static_cast<int>(k % across)) * kTileSide + ray % kTileSide;
  return to_world(grid.axis(), Vec3(grid.u(i), grid.v(j), w));
}

Loss loss_of(const Grid& grid, const Slab& slab, const SlabTiles& before, const SlabTiles& after) {
  Loss loss;
  double length = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    if (before[k] == after[k]) continue;
    for_each_loss(*before[k], *after[k], [&](int ray, double near, double far) {
      length += far - near;
      if (!(far - near > loss.longest)) return;
      loss.longest = far - near;
      loss.point = on_ray(grid, slab, k, ray, (near + far) / 2);
    });
  }
  loss.volume = length * grid.pitch() * grid.pitch();
  return loss;
}

}  // namespace riffler
