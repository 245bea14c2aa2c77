// One grid at a time to cut slabs on: a slab's tiles are put in, cut, and taken out.
#pragma once

#include <span>
#include <vector>

#include "riffler/dexel/stats.hpp"
#include "sweep/carve_moves.hpp"
#include "verify/slab.hpp"

namespace riffler::verify {

/// Of one thread. The grid is empty between calls.
class Workbench {
 public:
  /// `like`: a grid of the volume, for its rays; its tiles are not used.
  Workbench(const dexel::Grid& like, const Slab& slab, double tolerance);

  const dexel::Grid& grid() const { return grid_; }
  const Slab& slab() const { return slab_; }

  /// Cuts `tiles` with moves to poses[ends[k]] from the poses before; returns mm³ per move.
  std::vector<double> cut(SlabTiles& tiles, std::span<const sweep::ConvexGroup> cutter, std::span<const Pose> poses,
                          std::span<const std::uint32_t> ends);
  /// Whether the moves would take anything. The tile where the last answer was yes is asked first.
  bool touches(const SlabTiles& tiles, std::span<const sweep::ConvexGroup> shape, std::span<const Pose> poses,
               std::span<const std::uint32_t> ends);
  /// What one move would leave.
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
