#include "riffler/dexel/tile.hpp"

#include <algorithm>
#include <atomic>
#include <numeric>

namespace riffler::dexel {

const RayOffsets::Array& RayOffsets::none() {
  static const Array offsets{};
  return offsets;
}

const RayOffsets::Array& RayOffsets::one() {
  static const Array offsets = [] {
    Array each;
    std::iota(each.begin(), each.end(), 0U);
    return each;
  }();
  return offsets;
}

RayOffsets::RayOffsets(const Array& offsets) {
  for (const Array* common : {&none(), &one()})
    if (offsets == *common) {
      first_ = common->data();
      return;
    }
  own_ = base::make_shared_block<const Array>(offsets);
  first_ = own_->data();
}

bool RayOffsets::operator==(const RayOffsets& o) const {
  return first_ == o.first_ || std::equal(begin(), end(), o.begin());
}

std::size_t Tile::nbytes() const {
  return sizeof(Tile) + offset.nbytes() + spans.capacity() * sizeof(Span) + normals.capacity() * sizeof(SpanNormals);
}

std::uint64_t next_revision() {
  static std::atomic<std::uint64_t> counter{0};
  return ++counter;
}

void TileBuilder::clear() {
  rays_ = 0;
  tile_.spans.clear(), tile_.normals.clear();
  tile_.reach = {};
}

std::shared_ptr<Tile> TileBuilder::finish() {
  while (rays_ < kTileRays) next_ray();
  tile_.offset = RayOffsets(offset_);
  // The copy's vectors are exactly as long as their content; the builder keeps its capacity for the next tile.
  auto tile = base::make_shared_block<Tile>(tile_);
  tile->revision = next_revision();
  clear();
  return tile;
}

}  // namespace riffler::dexel
