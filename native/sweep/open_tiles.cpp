#include "sweep/open_tiles.hpp"

#include <utility>

namespace riffler::sweep {

void OpenTiles::reserve(const dexel::Grid& grid, std::size_t count) {
  places_.resize(grid.tile_count());
  entries_.reserve(grid.tile_count()), spare_.reserve(grid.tile_count());
  while (spare_.size() < count) {
    spare_.push_back(std::make_unique<OpenTile>());
    spare_.back()->reserve(grid.has_normals());
  }
}

OpenTile& OpenTiles::open(const dexel::Grid& grid, std::size_t tile, std::uint64_t move) {
  if (places_[tile] == 0) {
    if (spare_.empty()) spare_.push_back(std::make_unique<OpenTile>());
    entries_.push_back({tile, move, 0, std::move(spare_.back())});
    spare_.pop_back();
    places_[tile] = static_cast<std::uint32_t>(entries_.size());
  }
  Entry& entry = entries_[places_[tile] - 1];
  entry.used = move;
  if (entry.rays->source() != grid.shared_tile(tile)) entry.rays->begin(grid, tile);
  return *entry.rays;
}

void OpenTiles::close(std::size_t k) {
  entries_[k].rays->end();
  places_[entries_[k].tile] = 0;
  spare_.push_back(std::move(entries_[k].rays));
  if (k + 1 < entries_.size()) {
    entries_[k] = std::move(entries_.back());
    places_[entries_[k].tile] = static_cast<std::uint32_t>(k + 1);
  }
  entries_.pop_back();
}

void OpenTiles::clear() {
  while (!entries_.empty()) close(entries_.size() - 1);
}

}  // namespace riffler::sweep
