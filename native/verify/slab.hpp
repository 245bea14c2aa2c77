// Slabs: rectangles of whole tiles that are simulated independently. Columns are independent, so the combined result is
// bit-identical to that of the whole.
#pragma once

#include <memory>
#include <vector>

#include "riffler/dexel/volume.hpp"

namespace riffler::verify {

/// Tiles [u0, u1) × [v0, v1) of one of a volume's grids.
struct Slab {
  std::size_t grid = 0;
  int u0 = 0, u1 = 0, v0 = 0, v1 = 0;

  std::size_t tile_count() const { return static_cast<std::size_t>(u1 - u0) * static_cast<std::size_t>(v1 - v0); }
  /// Index in the grid's tiles of the slab's tile k.
  std::size_t place(const dexel::Grid& g, std::size_t k) const {
    const auto wide = static_cast<std::size_t>(v1 - v0);
    return g.tile_index(u0 + static_cast<int>(k / wide), v0 + static_cast<int>(k % wide));
  }
};

/// All slabs of a volume, grid by grid. Depends only on the frame, not on the number of threads or machines.
std::vector<Slab> slabs_of(const Volume& volume);

/// A slab's state: pointers to its tiles. A copy is a snapshot.
using SlabTiles = std::vector<std::shared_ptr<const dexel::Tile>>;

SlabTiles tiles_of(const dexel::Grid& grid, const Slab& slab);
void put_tiles(dexel::Grid& grid, const Slab& slab, const SlabTiles& tiles);

/// World-frame bounding box of a slab's material: half a pitch around its rays, its spans exactly. Empty without
/// material.
Box3 material_box(const dexel::Grid& grid, const Slab& slab, const SlabTiles& tiles);

}  // namespace riffler::verify
