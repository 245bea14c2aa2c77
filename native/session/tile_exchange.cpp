#include "riffler/session/tile_exchange.hpp"

#include <utility>

namespace riffler::session {

TileExchange::TileExchange(const Volume& volume) {
  std::size_t tiles = 0;
  for (const dexel::Grid& grid : volume.grids()) {
    first_.push_back(tiles);
    tiles += grid.tile_count();
  }
  dirty_.resize(tiles);
  list_.reserve(tiles), box_.reserve(tiles);
}

void TileExchange::changed(std::span<const Place> places) noexcept {
  for (const Place& place : places) {
    auto dirty = dirty_[first_[place.grid] + place.tile];
    if (dirty) continue;
    dirty = true;
    list_.push_back(place);  // each tile once: the capacity suffices
  }
}

void TileExchange::serve(const Volume& cut, const Mark& mark) noexcept {
  if (!asked()) return;
  for (const Place& place : list_) {
    box_.push_back({place, cut.grids()[place.grid].shared_tile(place.tile)});
    dirty_[first_[place.grid] + place.tile] = false;
  }
  list_.clear();
  mark_ = mark;
  state_.store(State::Full, std::memory_order_release);
}

void TileExchange::ask() noexcept {
  State idle = State::Idle;
  state_.compare_exchange_strong(idle, State::Asked, std::memory_order_release, std::memory_order_relaxed);
}

bool TileExchange::take(Volume& shown, std::vector<Place>& places, Mark& mark) {
  if (state_.load(std::memory_order_acquire) != State::Full) return false;
  places.reserve(places.size() + box_.size());
  for (Handed& handed : box_) {
    places.push_back(handed.place);
    shown.grids()[handed.place.grid].set_tile(handed.place.tile, std::move(handed.tile));
  }
  if (!box_.empty()) shown.touch();
  box_.clear();
  mark = mark_;
  state_.store(State::Idle, std::memory_order_release);
  return true;
}

}  // namespace riffler::session
