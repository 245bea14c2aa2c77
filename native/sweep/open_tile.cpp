#include "sweep/open_tile.hpp"

#include <algorithm>
#include <span>

namespace riffler::sweep {

namespace {

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

}  // namespace

void OpenTile::begin(const dexel::Grid& grid, std::size_t tile) {
  end();
  with_normals_ = grid.has_normals();
  thinnest_ = thinnest(grid);
  planes_ = {};
  planes_.two = two_, planes_.many = many_, planes_.pending = pending_;
  std::fill(std::begin(two_), std::end(two_), 0U), std::fill(std::begin(many_), std::end(many_), 0U);
  std::fill(std::begin(pending_), std::end(pending_), 0U);
  pool_.clear();
  if (!grid.tile(tile).offset.one_each()) unpack(grid.tile(tile));
  source_ = grid.shared_tile(tile);
}

void OpenTile::Plane::reserve(bool with_normals) {
  spans.resize(kRoom);
  if (with_normals) origins.resize(kRoom), normals.resize(kRoom);
}

void OpenTile::reserve(bool with_normals) {
  first_.reserve(with_normals), last_.reserve(with_normals);
  hull_.resize(kRoom);
  if (!with_normals) return;  // seen from one direction, few rays have more than two spans
  pool_.reserve(), kept_.reserve(64);
}

void OpenTile::unpack(const dexel::Tile& tile) {
  first_.reserve(with_normals_), last_.reserve(with_normals_);
  hull_.resize(kRoom);
  planes_.hull = hull_.data();
  planes_.first = first_.spans.data(), planes_.last = last_.spans.data();
  if (with_normals_) {
    planes_.first_origins = first_.origins.data(), planes_.last_origins = last_.origins.data();
    planes_.first_normals = first_.normals.data(), planes_.last_normals = last_.normals.data();
    std::fill_n(first_.origins.data(), dexel::kTileRays, Origins{});
  }
  if (tile.offset.one_each()) {
    std::copy_n(tile.spans.data(), dexel::kTileRays, first_.spans.data());
    if (with_normals_) std::copy_n(tile.normals.data(), dexel::kTileRays, first_.normals.data());
    return;
  }
  for (int r = 0; r < dexel::kTileRays; ++r) {
    const std::uint32_t begin = tile.offset[r], n = tile.offset[r + 1] - begin;
    if (n == 1) {
      first_.spans[r] = tile.spans[begin];
      if (with_normals_) first_.normals[r] = tile.normals[begin];
      continue;
    }
    kept_.clear();
    for (std::uint32_t k = begin; k < begin + n; ++k)
      kept_.push_back({tile.spans[k], with_normals_ ? tile.normals[k] : dexel::SpanNormals{}, {}});
    put(r, kept_.data(), n, 0);
  }
}

const RayPlanes& OpenTile::open() {
  changed_ = true;
  open_planes();
  return planes_;
}

void OpenTile::put(int r, const Piece* pieces, std::uint32_t n, std::uint32_t pair) {
  std::uint32_t &two = two_[r / dexel::kTileSide], &many = many_[r / dexel::kTileSide];
  const auto into = [&](Plane& plane, const Piece& p) {
    plane.spans[r] = p.span;
    if (with_normals_) plane.normals[r] = p.normals, plane.origins[r] = p.origins;
  };
  if (n > 2) {
    PiecePool::Place& at = pool_.room(r, n, many_);
    at.count = n, at.pair = pair;
    hull_[r] = {pieces[0].span.near, pieces[n - 1].span.far};
    std::copy(pieces, pieces + n, pool_.pieces(at));
  }
  two = n > 1 ? two | bit(r) : two & ~bit(r);
  many = n > 2 ? many | bit(r) : many & ~bit(r);
  if (n == 0) {
    first_.spans[r] = {kNone, -kNone};
    return;
  }
  into(first_, pieces[pair]);
  if (n > 1) into(last_, pieces[pair + 1]);
}

/// Index in `kept_` of the first of the two spans at both sides of a cut.
std::uint32_t OpenTile::pair_at(const Interval& cut) const {
  std::uint32_t pair = 0;
  while (pair + 2 < kept_.size() && kept_[pair + 1].span.near < cut.near) ++pair;
  return pair;
}

/// A cut in a gap of ray r: the next ones, which mostly are in the same gap, find its two sides in the planes.
void OpenTile::follow(int r, const Interval& cut) {
  if (!is(many_, r)) return;
  const std::uint32_t pair = pair_at(cut);
  if (pair != pool_.at(r).pair) put(r, kept_.data(), static_cast<std::uint32_t>(kept_.size()), pair);
}

void OpenTile::store(int r, const Interval& cut) {
  changed_ = true;
  put(r, kept_.data(), static_cast<std::uint32_t>(kept_.size()), pair_at(cut));
  if (with_normals_) pending_[r / dexel::kTileSide] |= bit(r);
}

std::uint32_t OpenTile::count(int r) const {
  if (is(many_, r)) return pool_.at(r).count;
  return is(two_, r) ? 2U : (first_.spans[r].near < first_.spans[r].far ? 1U : 0U);
}

std::shared_ptr<const dexel::Tile> OpenTile::pack() {
  auto tile = base::make_shared_block<dexel::Tile>();
  dexel::RayOffsets::Array offset;
  std::uint32_t total = 0;
  for (int row = 0; row < dexel::kTileSide; ++row) {
    const int begin = row * dexel::kTileSide, end = begin + dexel::kTileSide;
    if (two_[row])
      for (int r = begin; r < end; ++r) offset[r] = total, total += count(r);
    else
      for (int r = begin; r < end; ++r) offset[r] = total, total += first_.spans[r].near < first_.spans[r].far;
  }
  offset[dexel::kTileRays] = total;
  tile->offset = dexel::RayOffsets(offset);
  tile->spans.resize(total);
  if (with_normals_) tile->normals.resize(total);
  dexel::Span* const spans = tile->spans.data();
  dexel::SpanNormals* const normals = tile->normals.data();
  for (int row = 0; row < dexel::kTileSide; ++row) {
    const int begin = row * dexel::kTileSide;
    std::uint32_t at = offset[begin];
    if (!two_[row] && offset[begin + dexel::kTileSide] - at == dexel::kTileSide) {
      std::copy_n(first_.spans.data() + begin, dexel::kTileSide, spans + at);
      if (with_normals_) std::copy_n(first_.normals.data() + begin, dexel::kTileSide, normals + at);
      continue;
    }
    for (int r = begin; r < begin + dexel::kTileSide; ++r)
      each(r, [&](const Piece& p) {
        spans[at] = p.span;
        if (with_normals_) normals[at] = p.normals;
        ++at;
      });
  }
  tile->reach = hull(tile->spans, source_->reach);
  tile->revision = dexel::next_revision();
  changed_ = false;
  std::fill(std::begin(pending_), std::end(pending_), 0U);
  source_ = tile;
  return tile;
}

}  // namespace riffler::sweep
