// The simulation of one slab: cutting, rapids in material, shank and holder in it, gouges; the whole tool in fixtures.
#pragma once

#include <functional>

#include "verify/event.hpp"
#include "verify/gouge.hpp"
#include "verify/moves.hpp"
#include "verify/workbench.hpp"

namespace riffler::verify {

/// A slab of the stock or of a fixture, and what its simulation goes by.
struct SlabPlace {
  const dexel::Grid& grid;  ///< for its rays; its tiles are not used
  Slab slab;
  std::int32_t fixture = -1;  ///< number of the fixture; −1: the stock
  /// Whether this is the grid that shank and holder are tried on, and that volumes are taken from.
  bool probed = false;
  double tolerance = 0;                  ///< mm: as for carve; contact less deep than it is none
  const PartSurface* surface = nullptr;  ///< null without a part, and for fixtures
  SlabTiles part = {};                   ///< the part's material in the slab, where there is a surface
};

/// Called after each batch of moves that cut, with the last of their rows and the slab after it.
using SlabSaved = std::function<void(std::int64_t row, const SlabTiles& tiles)>;

/// Runs the moves from place `first` on. `tiles`: the slab before them, then after them; nothing cuts a fixture. Adds
/// to `report` and `stats`. What comes out depends on the slab and the moves only, not on how moves are split into
/// calls.
void simulate(const SlabPlace& place, const Moves& moves, std::size_t first, SlabTiles& tiles, SlabReport& report,
              VerifyStats& stats, const SlabSaved& saved = {});

}  // namespace riffler::verify
