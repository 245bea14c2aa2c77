#include "sweep/tile_cut.hpp"

#include <algorithm>

namespace riffler {

void TileCut::open() {
  if (changed_) return;
  changed_ = true;
  begin_.assign(tile_.offset.begin(), tile_.offset.end() - 1);
  count_.resize(kTileRays);
  for (int r = 0; r < kTileRays; ++r) count_[r] = tile_.offset[r + 1] - tile_.offset[r];
  spans_ = tile_.spans;
  normals_ = tile_.normals;
}

void TileCut::store(int r) {
  const auto n = static_cast<std::uint32_t>(kept_.size());
  if (n > count_[r]) {
    begin_[r] = static_cast<std::uint32_t>(spans_.size());
    spans_.resize(spans_.size() + n);
    if (with_normals_) normals_.resize(spans_.size());
  }
  count_[r] = n;
  std::copy(kept_.begin(), kept_.end(), spans_.begin() + begin_[r]);
  std::copy(kept_normals_.begin(), kept_normals_.end(), normals_.begin() + (with_normals_ ? begin_[r] : 0));
}

std::shared_ptr<Tile> TileCut::finish() const {
  auto tile = std::make_shared<Tile>();
  std::size_t total = 0;
  for (const std::uint32_t n : count_) total += n;
  tile->spans.reserve(total);
  if (with_normals_) tile->normals.reserve(total);
  for (int r = 0; r < kTileRays; ++r) {
    const auto from = spans_.begin() + begin_[r];
    tile->spans.insert(tile->spans.end(), from, from + count_[r]);
    if (with_normals_) {
      const auto normal = normals_.begin() + begin_[r];
      tile->normals.insert(tile->normals.end(), normal, normal + count_[r]);
    }
    tile->offset[r + 1] = static_cast<std::uint32_t>(tile->spans.size());
    if (count_[r] > 0) {
      const auto last = from + (count_[r] - 1);
      tile->reach.include(from->near), tile->reach.include(last->far);
    }
  }
  tile->revision = next_revision();
  return tile;
}

}  // namespace riffler
