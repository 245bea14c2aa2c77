// The tiles of a grid that a path touches, and which moves touch each of them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/geom/rolled_pose.hpp"
#include "riffler/tool/hull.hpp"
#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// Moves first … end − 1; move m goes from poses[m] to poses[m + 1].
struct MoveRun {
  std::uint32_t first, end;
};

/// A tile is touched by a move if one of its rays is under the footprint of one of the move's steps, at any height.
/// `carve` changes no other tile.
struct TouchedTiles {
  std::vector<std::uint32_t> tiles;  ///< ascending
  std::vector<std::uint32_t> begin;  ///< index in `runs` for each tile, then the end
  std::vector<MoveRun> runs;         ///< ascending and disjoint within a tile

  /// The runs of tiles[k].
  std::span<const MoveRun> of(std::size_t k) const { return {runs.data() + begin[k], runs.data() + begin[k + 1]}; }
  /// Index of a tile that is in `tiles`.
  std::size_t index(std::size_t tile) const;
  std::size_t nbytes() const;
};

/// Poses and tolerance as `carve` gets them, checked.
TouchedTiles touched_tiles(const dexel::Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                           double tolerance, const Progress& progress = {});
TouchedTiles touched_tiles(const dexel::Grid& grid, std::span<const tool::Hull> hulls,
                           std::span<const RolledPose> poses, double tolerance, const Progress& progress = {});

}  // namespace riffler::sweep
