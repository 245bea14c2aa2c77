// One grid for cutting slabs: a slab's tiles are inserted, cut and taken out.
#pragma once

#include <span>
#include <vector>

#include "riffler/dexel/stats.hpp"
#include "sweep/carve_moves.hpp"
#include "verify/slab.hpp"

namespace riffler::verify {

/// For one thread. The grid is empty between calls.
class Workbench {
 public:
  /// `like`: a grid of the volume that defines the rays; its tiles are not used.
  Workbench(const dexel::Grid& like, const Slab& slab, double tolerance);

  const dexel::Grid& grid() const { return grid_; }
  const Slab& slab() const { return slab_; }

  /// Cuts `tiles` with moves to poses[ends[k]] from the preceding poses; returns mm³ per move.
  std::vector<double> cut(SlabTiles& tiles, std::span<const sweep::ConvexGroup> cutter, std::span<const Pose> poses,
                          std::span<const std::uint32_t> ends);
  /// Whether the moves would remove anything. Tests the tile of the last positive answer first.
  bool touches(const SlabTiles& tiles, std::span<const sweep::ConvexGroup> shape, std::span<const Pose> poses,
               std::span<const std::uint32_t> ends);
  /// The tiles that one move would leave.
  SlabTiles after(const SlabTiles& tiles, std::span<const sweep::ConvexGroup> shape, const Pose& from, const Pose& to);

 private:
  dexel::Grid grid_;
  Slab slab_;
  SlabTiles nothing_;
  double tolerance_;
  std::size_t hint_ = 0;
  dexel::Stats stats_;
};

}  // namespace riffler::verify
