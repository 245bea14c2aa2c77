// Simulation of one slab: cutting, rapids in material, collisions of shank and holder, gouges; the whole tool in
// fixtures.
#pragma once

#include <functional>

#include "verify/event.hpp"
#include "verify/gouge.hpp"
#include "verify/moves.hpp"
#include "verify/workbench.hpp"

namespace riffler::verify {

/// A slab of the stock or a fixture, with the inputs of its simulation.
struct SlabPlace {
  const dexel::Grid& grid;  ///< defines the rays; its tiles are not used
  Slab slab;
  std::int32_t fixture = -1;  ///< index of the fixture; −1: the stock
  /// Whether this is the grid on which shank and holder are tested and volumes are measured.
  bool probed = false;
  double tolerance = 0;                  ///< mm: as for carve; contact less deep than this is ignored
  const PartSurface* surface = nullptr;  ///< null without a part, and for fixtures
  SlabTiles part = {};                   ///< the part's material in the slab, if there is a part
};

/// Called after each batch of moves that cut, with its last row and the slab after it.
using SlabSaved = std::function<void(std::int64_t row, const SlabTiles& tiles)>;

/// Runs the moves from index `first` on. `tiles`: the slab before, and on return after, the moves; fixtures are not
/// cut. Adds to `report` and `stats`. The result depends only on slab and moves, not on how moves are split into calls.
void simulate(const SlabPlace& place, const Moves& moves, std::size_t first, SlabTiles& tiles, SlabReport& report,
              VerifyStats& stats, const SlabSaved& saved = {});

}  // namespace riffler::verify
