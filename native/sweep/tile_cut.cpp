#include "sweep/tile_cut.hpp"

#include <algorithm>

namespace riffler {

TileCut::TileCut(const Tile& tile, bool with_normals, double thinnest)
    : with_normals_(with_normals), thinnest_(thinnest), many_{} {
  if (with_normals_) normals_.resize(kTileRays);
  std::fill(near_ + kTileRays, near_ + kTileRays + kLanes, kNone);
  std::fill(far_ + kTileRays, far_ + kTileRays + kLanes, -kNone);
  for (int r = 0; r < kTileRays; ++r) {
    const std::uint32_t n = tile.offset[r + 1] - tile.offset[r];
    const Span* spans = tile.spans.data() + tile.offset[r];
    if (n == 1) {
      near_[r] = spans->near, far_[r] = spans->far;
      if (with_normals_) normals_[r] = tile.normals[tile.offset[r]];
    } else {
      put(r, spans, with_normals_ ? tile.normals.data() + tile.offset[r] : nullptr, n);
    }
  }
}

void TileCut::put(int r, const Span* spans, const SpanNormals* normals, std::uint32_t n) {
  std::uint32_t& row = many_[r / kTileSide];
  const std::uint32_t bit = 1U << (r % kTileSide);
  const bool was_many = row & bit;
  near_[r] = n ? spans[0].near : kNone, far_[r] = n ? spans[n - 1].far : -kNone;
  row = n > 1 ? row | bit : row & ~bit;
  if (n == 1 && with_normals_) normals_[r] = normals[0];
  if (n <= 1) return;
  if (begin_.empty()) begin_.resize(kTileRays), count_.resize(kTileRays);
  if (!was_many || n > count_[r]) {
    begin_[r] = static_cast<std::uint32_t>(pool_.size());
    pool_.resize(pool_.size() + n);
    if (with_normals_) pool_normals_.resize(pool_.size());
  }
  count_[r] = n;
  std::copy(spans, spans + n, pool_.begin() + begin_[r]);
  if (with_normals_) std::copy(normals, normals + n, pool_normals_.begin() + begin_[r]);
}

void TileCut::store(int r) {
  changed_ = true;
  put(r, kept_.data(), kept_normals_.data(), static_cast<std::uint32_t>(kept_.size()));
}

/// No ray holds several spans.
void TileCut::pack_single(Tile& tile) const {
  tile.spans.resize(kTileRays);
  if (with_normals_) tile.normals.resize(kTileRays);
  std::uint32_t total = 0;
  double low = kNone, high = -kNone;
  for (int r = 0; r < kTileRays; ++r) {
    tile.offset[r] = total;
    tile.spans[total] = {near_[r], far_[r]};
    if (with_normals_) tile.normals[total] = normals_[r];
    low = std::min(low, near_[r]), high = std::max(high, far_[r]);  // empty rays do not count: near is infinite
    total += near_[r] < far_[r];
  }
  tile.offset[kTileRays] = total;
  if (low < high) tile.reach = {low, high};
  if (total == kTileRays) return;
  tile.spans.resize(total), tile.spans.shrink_to_fit();
  if (with_normals_) tile.normals.resize(total), tile.normals.shrink_to_fit();
}

void TileCut::pack_all(Tile& tile) const {
  std::uint32_t total = 0;
  for (int r = 0; r < kTileRays; ++r) tile.offset[r] = total, total += count(r);
  tile.offset[kTileRays] = total;
  tile.spans.resize(total);
  if (with_normals_) tile.normals.resize(total);
  for (int r = 0; r < kTileRays; ++r) {
    const std::uint32_t n = tile.offset[r + 1] - tile.offset[r];
    if (n == 0) continue;
    tile.reach.include(near_[r]), tile.reach.include(far_[r]);
    for (std::uint32_t k = 0; k < n; ++k) {
      tile.spans[tile.offset[r] + k] = span(r, k);
      if (with_normals_) tile.normals[tile.offset[r] + k] = normal(r, k);
    }
  }
}

std::shared_ptr<Tile> TileCut::finish() const {
  auto tile = std::make_shared<Tile>();
  if (pool_.empty())
    pack_single(*tile);
  else
    pack_all(*tile);
  tile->revision = next_revision();
  return tile;
}

}  // namespace riffler
