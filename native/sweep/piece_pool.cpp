#include "sweep/piece_pool.hpp"

#include <algorithm>

namespace riffler::sweep {

void PiecePool::reserve() {
  places_.resize(dexel::kTileRays);
  blocks_.reserve(8);
  if (blocks_.empty()) blocks_.emplace_back().reserve(kBlock);
}

void PiecePool::clear() {
  if (blocks_.size() > 1) blocks_.resize(1);
  if (!blocks_.empty()) blocks_.front().clear();
  held_ = 0, most_ = kBlock;
}

PiecePool::Place PiecePool::extend(Blocks& blocks, std::uint32_t room) {
  if (blocks.empty() || blocks.back().size() + room > blocks.back().capacity())
    blocks.emplace_back().reserve(std::max(room, kBlock));
  auto& last = blocks.back();
  const auto begin = static_cast<std::uint32_t>(last.size());
  last.resize(last.size() + room);
  return {static_cast<std::uint32_t>(blocks.size() - 1), begin, 0, room, 0};
}

PiecePool::Place& PiecePool::room(int ray, std::uint32_t n, const std::uint32_t* used) {
  if (held_ == 0) places_.assign(dexel::kTileRays, {});
  const auto r = static_cast<std::size_t>(ray);
  const std::uint32_t before = places_[r].room;
  if (n <= before) return places_[r];
  // More for a ray that grows again, so that all its places together are a few times the last one.
  const std::uint32_t room = before > 0 ? n + n / 2 : n;
  if (held_ + room > most_) tidy(used);
  places_[r] = extend(blocks_, room);
  held_ += room;
  return places_[r];
}

/// Closes the gaps that rays which grew have left.
void PiecePool::tidy(const std::uint32_t* used) {
  Blocks tight;
  base::BlockVector<Place> places(dexel::kTileRays);
  std::size_t held = 0;
  for (std::size_t r = 0; r < dexel::kTileRays; ++r) {
    const Place& from = places_[r];
    if (!(used[r / dexel::kTileSide] & (1U << (r % dexel::kTileSide))) || from.count == 0) continue;
    Place& to = places[r] = extend(tight, from.count);
    to.count = from.count, to.pair = from.pair;
    std::copy_n(pieces(from), from.count, tight[to.block].data() + to.begin);
    held += from.count;
  }
  blocks_.swap(tight), places_.swap(places);
  held_ = held, most_ = std::max<std::size_t>(kBlock, 2 * held);
}

}  // namespace riffler::sweep
