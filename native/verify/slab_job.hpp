// The slabs of a verification and their states.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "verify/simulate.hpp"

namespace riffler::verify {

/// A slab of the stock or of a fixture.
struct SlabJob {
  std::int32_t fixture = -1;  ///< −1: the stock
  Slab slab;
  bool probed = false;  ///< belongs to the grid on which shank and holder are tested and volumes are measured
  Box3 material;        ///< material before the first move
};

/// A slab's state after all rows up to `row` that can touch it.
struct SlabSnapshot {
  std::int64_t row;
  SlabTiles tiles;
};

/// Copies share their tiles.
struct SlabState {
  SlabTiles tiles;
  SlabReport report;
  std::vector<SlabSnapshot> snapshots;   ///< in row order; the first is the stock itself, row 0
  std::uint64_t spacing = 1, since = 0;  ///< batches between snapshots
  std::int64_t done = 0;                 ///< rows up to this one are simulated

  static constexpr std::size_t kMaxSnapshots = 12;

  /// Called after each batch. Keeps a snapshot at every `spacing`-th call; halves their number when there are too many.
  void save(std::int64_t row, const SlabTiles& now);
  /// Returns to the last snapshot before `row` and discards the results of later rows.
  void rewind(std::int64_t row);
  /// Shifts the numbers of rows from `from` on by `shift`.
  void renumber(std::int64_t from, std::int64_t shift);
};

}  // namespace riffler::verify
