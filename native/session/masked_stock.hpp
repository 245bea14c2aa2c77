// The part of a stock that a session may cut: its material, or the air in its box, minus a protected region; and the
// combined volume for display.
#pragma once

#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/session/tile_exchange.hpp"
#include "riffler/sweep/carve.hpp"

namespace riffler::session {

/// The loop cuts this volume like any other. It knows neither the mask nor the add mode, so a step costs the same and
/// feels what it removes. The displaying side combines both, tile by tile: the initial stock minus, or plus, what was
/// cut since the start. The result is therefore independent of how often it is displayed.
class MaskedStock {
 public:
  /// `mode`: whether the cut volume is removed from the stock or added to it. `protect`: a mask, or null. Throws
  /// std::invalid_argument if the frames of mask and stock differ.
  MaskedStock(const Volume& stock, sweep::CarveMode mode, const Volume* protect);

  sweep::CarveMode mode() const { return mode_; }
  const Volume& volume() const { return masked_stock_; }
  /// Updates the tiles `places` (possibly repeated) of the combined volume `shown` for the remainder `left` of
  /// volume().
  void show(const Volume& left, std::span<const TileExchange::Place> places, Volume& shown) const;
  /// The combined volume for the remainder `left` of volume().
  Volume whole(const Volume& left) const;

 private:
  sweep::CarveMode mode_;
  Volume stock_, masked_stock_;
};

}  // namespace riffler::session
