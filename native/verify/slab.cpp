#include "verify/slab.hpp"

#include <algorithm>

namespace riffler::verify {

namespace {

/// Slabs along the longer side of a grid, and limits for tiles along a slab's side. A slab of 4 × 4 tiles fits a core's
/// own cache; the smaller the slabs, the more moves touch two of them.
constexpr int kAcross = 8, kMin = 2, kMax = 8;

}  // namespace

std::vector<Slab> slabs_of(const Volume& volume) {
  std::vector<Slab> out;
  for (std::size_t g = 0; g < volume.grids().size(); ++g) {
    const dexel::Grid& grid = volume.grids()[g];
    const int longer = std::max(grid.tiles_u(), grid.tiles_v());
    const int side = std::clamp((longer + kAcross - 1) / kAcross, kMin, kMax);
    for (int u = 0; u < grid.tiles_u(); u += side)
      for (int v = 0; v < grid.tiles_v(); v += side)
        out.push_back({g, u, std::min(u + side, grid.tiles_u()), v, std::min(v + side, grid.tiles_v())});
  }
  return out;
}

SlabTiles tiles_of(const dexel::Grid& grid, const Slab& slab) {
  SlabTiles out(slab.tile_count());
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = grid.shared_tile(slab.place(grid, k));
  return out;
}

void put_tiles(dexel::Grid& grid, const Slab& slab, const SlabTiles& tiles) {
  for (std::size_t k = 0; k < tiles.size(); ++k) grid.set_tile(slab.place(grid, k), tiles[k]);
}

Box3 material_box(const dexel::Grid& grid, const Slab& slab, const SlabTiles& tiles) {
  Box3 box;
  const double half = 0.5001 * grid.pitch(), wide = dexel::kTileSide * grid.pitch();
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (tiles[k]->spans.empty()) continue;
    const auto across = static_cast<std::size_t>(slab.v1 - slab.v0);
    const int u = (slab.u0 + static_cast<int>(k / across)) * dexel::kTileSide,
              v = (slab.v0 + static_cast<int>(k % across)) * dexel::kTileSide;
    box.add(Vec3(grid.u(u) - half, grid.v(v) - half, tiles[k]->reach.near));
    box.add(Vec3(grid.u(u) - half + wide, grid.v(v) - half + wide, tiles[k]->reach.far));
  }
  if (box.empty()) return box;
  return {to_world(grid.axis(), box.lower), to_world(grid.axis(), box.upper)};
}

}  // namespace riffler::verify
