// The simulation of one slab: cutting, rapids in material, shank and holder in it, gouges.
#pragma once

#include <functional>
#include <optional>

#include "verify/event.hpp"
#include "verify/gouge.hpp"
#include "verify/moves.hpp"
#include "verify/workbench.hpp"

namespace riffler {

/// Cuts a slab of the stock with the moves that can touch it. What comes out depends on the slab and the moves only,
/// not on how they are split into calls.
class SlabSimulation {
 public:
  /// `grid`: of the stock, for its rays. `probed`: whether this is the grid that shank and holder are tried on, and
  /// that volumes are taken from. `surface` may be null; `part`: the part's material in the slab.
  SlabSimulation(const Grid& grid, const Slab& slab, bool probed, double tolerance, const PartSurface* surface,
                 SlabTiles part);

  /// Runs the moves from place `first` on. `state` is the slab before them, then after them. `saved(row, state)` is
  /// called after each batch that cut.
  using Saved = std::function<void(std::int64_t, const SlabTiles&)>;
  void run(const Moves& moves, std::size_t first, SlabTiles& state, SlabReport& report, VerifyStats& stats,
           const Saved& saved = {});

 private:
  struct Touched {
    std::size_t move;
    Moves::Touch touch;
  };
  using Batch = std::span<const Touched>;

  void pass(Batch batch);
  void cut(Batch batch);
  bool alarm(Batch batch);
  bool near_material(std::size_t move) const;
  void find_rapids(Batch batch, std::span<const double> taken, SlabTiles before);
  void find_strikes(const Touched& touched);
  bool measured(std::size_t move) const;
  struct Strike;
  bool strike(SlabTiles& state, const Probe& probe, const Touched& touched, double t0, double t1, int halvings,
              Strike& out);

  Workbench bench_;
  bool probed_;
  double tolerance_;
  const PartSurface* surface_;
  SlabTiles part_;
  // Of the run under way.
  const Moves* moves_ = nullptr;
  SlabTiles* state_ = nullptr;
  SlabReport* report_ = nullptr;
  VerifyStats* stats_ = nullptr;
};

/// Tries the moves on a fixture, which nothing cuts: `fixture` is its number. Only a slab of its defining grid.
void simulate_fixture(const Grid& grid, const Slab& slab, std::int32_t fixture, double tolerance, const Moves& moves,
                      std::size_t first, SlabReport& report, VerifyStats& stats);

}  // namespace riffler
