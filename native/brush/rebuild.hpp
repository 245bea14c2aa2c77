// Cuts the rays of one direction again after a patch has been displaced.
#pragma once

#include <memory>
#include <vector>

#include "brush/crossings.hpp"
#include "riffler/dexel/stats.hpp"

namespace riffler::brush {

/// Rebuilds rays of one grid of a volume. An old end moves as the mesh moves at it: the new crossing plus the old end's
/// distance from the old crossing, as far as the surface has not slid past the ray. So detail finer than the mesh is
/// kept, and where the displacement is 0 the end keeps its bits. What the mesh does not show, walls and gaps thinner
/// than the pitch, moves along its own normal.
class Rebuild {
 public:
  Rebuild(const dexel::Grid& grid, const Crop& crop, const Patch& patch, const Displacement& displacement);

  /// The numbers of the grid's tiles with rays that may change, ascending.
  std::vector<std::size_t> tiles() const;

  struct Result {
    std::shared_ptr<const dexel::Tile> tile;  ///< the tile itself if nothing changes
    double lost = 0;                          ///< as BrushResult::lost, along this grid's rays
    bool clipped = false;
    dexel::Stats stats;
  };
  /// May be called from several threads at once.
  Result run(std::size_t tile) const;

 private:
  const dexel::Grid& grid_;
  const dexel::Grid& own_;  // the crop's
  const Displacement& displacement_;
  Vec3 origin_;  // in the cyclic frame
  int i0_, j0_;  // ray (0, 0) of the crop in the grid
  CrossedRays rays_;
};

}  // namespace riffler::brush
