#include "verify/rest.hpp"

#include <vector>

#include "riffler/base/parallel.hpp"

namespace riffler::verify {

namespace {

Rest rest_in_tile(const Target& target, const dexel::Grid& grid, std::size_t tile, double tolerance) {
  const int u0 = static_cast<int>(tile) / grid.tiles_v() * dexel::kTileSide,
            v0 = static_cast<int>(tile) % grid.tiles_v() * dexel::kTileSide;
  const mesh::Closest& closest = target.surface().closest();
  Rest worst;
  for (int r = 0; r < dexel::kTileRays; ++r)
    for (const dexel::Span& span : grid.tile(tile).ray(r))
      for (const double end : {span.near, span.far}) {
        const Vec3 p =
            to_world(grid.axis(), Vec3(grid.u(u0 + r / dexel::kTileSide), grid.v(v0 + r % dexel::kTileSide), end));
        if (closest.within(p, std::max(tolerance, worst.height))) continue;
        const double height = closest.signed_distance(p, closest(p));
        if (height > std::max(tolerance, worst.height)) worst = {height, p};
      }
  return worst;
}

}  // namespace

Rest rest_on(const Target& target, const Volume& left, double tolerance, const Progress& progress) {
  std::vector<std::pair<const dexel::Grid*, std::size_t>> tiles;
  for (const dexel::Grid& grid : left.grids())
    for (std::size_t t = 0; t < grid.tile_count(); ++t) tiles.emplace_back(&grid, t);
  std::vector<Rest> found(tiles.size());
  base::parallel_for(
      tiles.size(), 1,
      [&](std::size_t k, std::size_t) { found[k] = rest_in_tile(target, *tiles[k].first, tiles[k].second, tolerance); },
      progress);
  Rest worst;
  for (const Rest& r : found)
    if (r.height > worst.height) worst = r;
  return worst;
}

}  // namespace riffler::verify
