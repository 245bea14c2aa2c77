// Operation counters. They show that the work grows with the tool's footprint, not with the grid.
#pragma once

#include <cstdint>

namespace riffler::dexel {

/// Counts since the last Volume::take_stats().
struct Stats {
  std::uint64_t moves = 0;          ///< moves carved
  std::uint64_t steps = 0;          ///< steps the moves were split into, summed over the tool's pieces
  std::uint64_t tiles_visited = 0;  ///< (tile, move) pairs whose rays were tested
  std::uint64_t tiles_changed = 0;  ///< tiles written
  std::uint64_t rays_tested = 0;    ///< (ray, step) pairs intersected with a swept piece
  std::uint64_t hits = 0;  ///< (ray, pose) intersections made for them: one per straight step, more per rotating step
  std::uint64_t rays_changed = 0;      ///< tested rays that lost material
  std::uint64_t tiles_meshed = 0;      ///< tiles turned into triangles
  std::uint64_t triangles_tested = 0;  ///< triangles tested against rays or tools
  std::uint64_t bytes_copied = 0;      ///< bytes of tiles copied on write

  Stats& operator+=(const Stats& o) {
    moves += o.moves, steps += o.steps, tiles_visited += o.tiles_visited, hits += o.hits,
        tiles_changed += o.tiles_changed;
    rays_tested += o.rays_tested, rays_changed += o.rays_changed, tiles_meshed += o.tiles_meshed;
    triangles_tested += o.triangles_tested, bytes_copied += o.bytes_copied;
    return *this;
  }
};

}  // namespace riffler::dexel
