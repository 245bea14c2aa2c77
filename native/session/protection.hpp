// A stock of which a mask protects a part: what may be cut, and the whole that is shown.
#pragma once

#include <span>

#include "dexel/volume.hpp"
#include "session/tile_exchange.hpp"

namespace riffler {

/// The loop cuts what is not protected, a volume as any other, and knows of no mask: a step costs what it always costs,
/// and feels what it takes. Whoever shows puts both together, tile by tile: the whole is the stock of the start less
/// what is gone since, so that it does not depend on how often somebody looked.
class Protection {
 public:
  /// std::invalid_argument where the mask's frame is another one than the stock's.
  Protection(const Volume& stock, const Volume& mask);

  /// Of the stock, what may be cut.
  const Volume& cuttable() const { return cuttable_; }
  /// Makes `shown`, the whole, what it is where `left` is left of cuttable(): these tiles, which may come twice.
  void show(const Volume& left, std::span<const TileExchange::Place> places, Volume& shown) const;
  /// The whole where `left` is left of cuttable().
  Volume whole(const Volume& left) const;

 private:
  Volume stock_, cuttable_;
};

}  // namespace riffler
