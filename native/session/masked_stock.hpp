// What of a stock a session may cut: its material, or the air in its box, less what a mask protects. And the whole that
// is shown.
#pragma once

#include <span>

#include "riffler/dexel/volume.hpp"
#include "riffler/session/tile_exchange.hpp"
#include "riffler/sweep/carve.hpp"

namespace riffler::session {

/// The loop cuts a volume as any other, and knows neither of a mask nor of what is put on: a step costs what it always
/// costs, and feels what it takes. Whoever shows puts both together, tile by tile: the whole is the stock of the start
/// less what was cut since, or with it, so that it does not depend on how often somebody looked.
class MaskedStock {
 public:
  /// `mode`: what is cut of it is taken from the stock, or put on. `protect`: a mask, or null. std::invalid_argument
  /// where the mask's frame is another one than the stock's.
  MaskedStock(const Volume& stock, sweep::CarveMode mode, const Volume* protect);

  sweep::CarveMode mode() const { return mode_; }
  const Volume& volume() const { return masked_stock_; }
  /// Makes `shown`, the whole, what it is where `left` is left of volume(): these tiles, which may come twice.
  void show(const Volume& left, std::span<const TileExchange::Place> places, Volume& shown) const;
  /// The whole where `left` is left of volume().
  Volume whole(const Volume& left) const;

 private:
  sweep::CarveMode mode_;
  Volume stock_, masked_stock_;
};

}  // namespace riffler::session
