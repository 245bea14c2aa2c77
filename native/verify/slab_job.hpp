// The slabs of a verification and where each of them stands.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "verify/simulate.hpp"

namespace riffler::verify {

/// A slab of the stock, or of a fixture.
struct SlabJob {
  std::int32_t fixture = -1;  ///< −1: the stock
  Slab slab;
  bool probed = false;  ///< of the grid that shank and holder are tried on and that volumes are taken from
  Box3 material;        ///< before the first move
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
  std::vector<SlabSnapshot> snapshots;   ///< by rows; the first is the stock itself, row 0
  std::uint64_t spacing = 1, since = 0;  ///< batches between snapshots
  std::int64_t done = 0;                 ///< rows up to this one have been run

  static constexpr std::size_t kMaxSnapshots = 12;

  /// Called after each batch. Keeps every so many, and half of them when there are too many.
  void save(std::int64_t row, const SlabTiles& now);
  /// Back to the last snapshot before `row`; what later rows did is forgotten.
  void rewind(std::int64_t row);
  /// Rows from `from` on are numbered anew.
  void renumber(std::int64_t from, std::int64_t shift);
};

}  // namespace riffler::verify
