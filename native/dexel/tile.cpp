#include "dexel/tile.hpp"

#include <atomic>

namespace riffler {

std::size_t Tile::nbytes() const {
  return sizeof(Tile) + spans.capacity() * sizeof(Span) + normals.capacity() * sizeof(SpanNormals);
}

std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> counter{0};
  return ++counter;
}

void TileBuilder::clear() {
  rays_ = 0;
  tile_.spans.clear(), tile_.normals.clear();
  tile_.reach = {};
  tile_.offset[0] = 0;
}

std::shared_ptr<Tile> TileBuilder::finish() {
  while (rays_ < kTileRays) next_ray();
  // The copy's vectors are exactly as long as their content; the builder keeps its capacity for the next tile.
  auto tile = std::make_shared<Tile>(tile_);
  tile->revision = next_revision();
  clear();
  return tile;
}

}  // namespace riffler
