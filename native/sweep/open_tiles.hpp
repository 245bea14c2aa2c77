// The tiles of a grid that stay open between the moves of a tool.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "riffler/dexel/grid.hpp"
#include "sweep/open_tile.hpp"

namespace riffler::sweep {

/// A tool that advances by a fraction of its diameter cuts nearly the same tiles in every move: they stay open, so that
/// they are unpacked and packed, and their normals are computed, only when the volume is needed.
class OpenTiles {
 public:
  struct Entry {
    std::size_t tile;
    std::uint64_t used;  ///< number of the move that last looked at it
    std::size_t tested;  ///< rays tested in one of the last steps that were put off, as a mean
    std::unique_ptr<OpenTile> rays;
  };

  /// Asks for the memory of as many open tiles of the grid.
  void reserve(const dexel::Grid& grid, std::size_t count);
  /// The open tile number `tile`. Opens it if it is not open yet, or if the grid has another tile there by now.
  OpenTile& open(const dexel::Grid& grid, std::size_t tile, std::uint64_t move);
  const std::vector<Entry>& entries() const { return entries_; }
  Entry& entry(std::size_t k) { return entries_[k]; }
  /// Index of the entry of tile number `tile`, which is open.
  std::size_t index(std::size_t tile) const { return places_[tile] - 1; }
  bool is_open(std::size_t tile) const { return places_[tile] != 0; }
  /// Closes entry k; the last entry takes its place.
  void close(std::size_t k);
  /// Closes all tiles. What was cut from them since they were packed is lost.
  void clear();

 private:
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> places_;             // by tile: 1 + index of its entry; 0: not open
  std::vector<std::unique_ptr<OpenTile>> spare_;  // closed, with their memory
};

}  // namespace riffler::sweep
