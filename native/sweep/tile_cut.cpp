#include "sweep/tile_cut.hpp"

#include <algorithm>

namespace riffler::sweep {

namespace {

/// Whether each ray of a row holds exactly one span.
bool one_each(const std::uint32_t* offset) {
  std::uint32_t other = 0;
  for (int k = 0; k < dexel::kTileSide; ++k) other |= (offset[k + 1] - offset[k]) ^ 1U;
  return other == 0;
}

/// Hull of spans within `before`; often the first few reach its ends.
Interval hull(std::span<const dexel::Span> spans, const Interval& before) {
  constexpr std::size_t kBlock = 32, kStrands = 4;  // independent strands: no comparison waits for the previous one
  Interval strands[kStrands], out;
  const auto include = [](Interval& to, const Interval& s) {
    to.near = s.near < to.near ? s.near : to.near, to.far = s.far > to.far ? s.far : to.far;
  };
  std::size_t k = 0;
  while (k + kBlock <= spans.size() && out != before) {
    for (const std::size_t end = k + kBlock; k < end; k += kStrands)
      for (std::size_t i = 0; i < kStrands; ++i) include(strands[i], {spans[k + i].near, spans[k + i].far});
    for (const Interval& s : strands) include(out, s);
  }
  for (; k < spans.size() && out != before; ++k) include(out, {spans[k].near, spans[k].far});
  return out;
}

TileScratch& scratch_of_thread() {
  thread_local TileScratch mine;
  return mine;
}

}  // namespace

TileCut::TileCut(const dexel::Tile& tile, bool with_normals, double thinnest)
    : tile_(tile),
      with_normals_(with_normals),
      packed_(tile.offset.one_each()),
      thinnest_(thinnest),
      rays_(tile.spans.data()),
      normals_(tile.normals.data()),
      many_{},
      scratch_(scratch_of_thread()) {
  scratch_.pool.clear(), scratch_.pool_normals.clear();
  if (!packed_) unpack();
}

void TileCut::unpack() {
  fresh_ = base::make_shared_block<dexel::Tile>();
  fresh_->spans.resize(dexel::kTileRays);
  if (with_normals_) fresh_->normals.resize(dexel::kTileRays);
  rays_ = fresh_->spans.data(), normals_ = fresh_->normals.data();
  for (int row = 0; row < dexel::kTileRays; row += dexel::kTileSide) {
    const std::uint32_t* offset = tile_.offset.data() + row;
    const dexel::Span* spans = tile_.spans.data();
    const dexel::SpanNormals* normals = with_normals_ ? tile_.normals.data() : nullptr;
    if (one_each(offset)) {
      std::copy_n(spans + *offset, dexel::kTileSide, fresh_->spans.begin() + row);
      if (with_normals_) std::copy_n(normals + *offset, dexel::kTileSide, fresh_->normals.begin() + row);
      continue;
    }
    for (int b = 0; b < dexel::kTileSide; ++b)
      put(row + b, spans + offset[b], with_normals_ ? normals + offset[b] : nullptr, offset[b + 1] - offset[b]);
  }
}

dexel::Span* TileCut::open() {
  changed_ = true;
  if (!fresh_) {
    fresh_ = base::make_shared_block<dexel::Tile>(tile_);
    rays_ = fresh_->spans.data(), normals_ = fresh_->normals.data();
  }
  return fresh_->spans.data();
}

void TileCut::put(int r, const dexel::Span* spans, const dexel::SpanNormals* normals, std::uint32_t n) {
  std::uint32_t& row = many_[r / dexel::kTileSide];
  const std::uint32_t bit = 1U << (r % dexel::kTileSide);
  fresh_->spans[r] = n ? dexel::Span{spans[0].near, spans[n - 1].far} : dexel::Span{kNone, -kNone};
  row = n > 1 ? row | bit : row & ~bit;
  if (n == 1 && with_normals_) fresh_->normals[r] = normals[0];
  if (n == 1) return;
  packed_ = false;
  if (n == 0) return;
  TileScratch& at = scratch_;
  if (at.pool.empty()) {
    at.begin.resize(dexel::kTileRays), at.count.resize(dexel::kTileRays), at.room.assign(dexel::kTileRays, 0);
    // More than rough tiles need, so that a pen's step seldom has to grow the pool.
    at.pool.reserve(16 * dexel::kTileRays), at.pool_normals.reserve(with_normals_ ? 16 * dexel::kTileRays : 0);
  }
  if (n > at.room[r]) {
    // Twice as much for a ray that grows again, so that all its places together are a few times the last one.
    at.room[r] = at.room[r] > 0 ? 2 * n : n;
    at.begin[r] = static_cast<std::uint32_t>(at.pool.size());
    at.pool.resize(at.pool.size() + at.room[r]);
    if (with_normals_) at.pool_normals.resize(at.pool.size());
  }
  at.count[r] = n;
  std::copy(spans, spans + n, at.pool.begin() + at.begin[r]);
  if (with_normals_) std::copy(normals, normals + n, at.pool_normals.begin() + at.begin[r]);
}

void TileCut::store(int r) {
  open();
  put(r, scratch_.kept.data(), scratch_.kept_normals.data(), static_cast<std::uint32_t>(scratch_.kept.size()));
}

/// Packs a tile in which no ray holds several spans: drops the empty places.
void TileCut::pack_single(dexel::Tile& tile) const {
  dexel::RayOffsets::Array offset;
  std::uint32_t total = 0;
  for (int r = 0; r < dexel::kTileRays; ++r) {
    offset[r] = total;
    const dexel::Span span = tile.spans[r];
    tile.spans[total] = span;
    if (with_normals_) tile.normals[total] = tile.normals[r];
    total += span.near < span.far;
  }
  offset[dexel::kTileRays] = total;
  tile.offset = dexel::RayOffsets(offset);
  tile.spans.resize(total), tile.spans.shrink_to_fit();
  if (with_normals_) tile.normals.resize(total), tile.normals.shrink_to_fit();
}

void TileCut::pack_all(dexel::Tile& tile) const {
  dexel::RayOffsets::Array offset;
  std::uint32_t total = 0;
  for (int r = 0; r < dexel::kTileRays; ++r) offset[r] = total, total += count(r);
  offset[dexel::kTileRays] = total;
  base::BlockVector<dexel::Span> spans(total);
  base::BlockVector<dexel::SpanNormals> normals(with_normals_ ? total : 0);
  for (int r = 0; r < dexel::kTileRays; ++r)
    for (std::uint32_t k = 0, at = offset[r]; at + k < offset[r + 1]; ++k) {
      spans[at + k] = span(r, k);
      if (with_normals_) normals[at + k] = normal(r, k);
    }
  tile.offset = dexel::RayOffsets(offset);
  tile.spans = std::move(spans), tile.normals = std::move(normals);
}

std::shared_ptr<dexel::Tile> TileCut::finish() {
  if (!changed_) return nullptr;
  dexel::Tile& tile = *fresh_;
  if (!scratch_.pool.empty())
    pack_all(tile);
  else if (!packed_)
    pack_single(tile);
  tile.reach = hull(tile.spans, tile_.reach);
  tile.revision = dexel::next_revision();
  return std::move(fresh_);
}

}  // namespace riffler::sweep
