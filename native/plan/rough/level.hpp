// One level of roughing: where the cutter moves at one height.
#pragma once

#include <optional>
#include <vector>

#include "plan/contours.hpp"
#include "plan/rough/entry.hpp"
#include "plan/rough/layer.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/plan/operation.hpp"

namespace riffler::plan {

/// What all levels share; lengths in mm, in the rows' frame.
struct LevelScene {
  const PlaceGrid& grid;
  const Field& heights;       ///< of the drop surface over the places; −∞ where the tool touches nothing
  const Field& ground;        ///< of part and fixtures + allowance over the cells; −∞ where there is none
  const DropCutter& surface;  ///< the drop surface itself
  const DropCutter& floor;    ///< the surface that no move may go below; nowhere higher than `surface`
  const StockTops& stock;     ///< before the first level: what higher levels leave of it is above this one
  double radius;              ///< of the cutter where a layer is cut
  double widest_radius;       ///< of the cutter anywhere
  double step;                ///< between a ring and the next
  double widest;              ///< width of cut that is asked for
  double ramp;                ///< length along which a pass goes to its full width
  double helix;               ///< radius of a helix with room
  double slot;                ///< length of a ramp with room, where there is none for a helix
  double sliver;              ///< thickness of material at a wall that is not worth a pass: the stock is no more exact
  double tolerance;           ///< of curves
  bool climb;                 ///< whether material lies to the right of the motion
};

/// Tips of the cutter and the kinds of the moves that end there. A move that goes deeper than before, or cuts wider
/// than asked for, is a lead. The first tip is free of material, or the last one of the run before, or where an entry
/// ends.
struct LevelRun {
  std::vector<Vec3> tips;
  std::vector<MoveKind> kinds;
  std::vector<double> rises;   ///< of the floor above the move to each tip, mm
  std::optional<Entry> entry;  ///< how the cutter comes down to the first tip
  bool linked = false;         ///< whether it begins where the run before ends
};

/// The runs of one level, in their order.
struct LevelRuns {
  std::vector<LevelRun> runs;
  double widest = 0;  ///< width of the cuts, mm
  std::size_t rings = 0, entries = 0;
  std::vector<Vec3> narrow;  ///< the widest place of each area that is too narrow for every entry, and is left out
  std::vector<Vec3> holes;   ///< a place in each area with stock that the cutter is too wide for
};

/// Clears the layer above height `z` from where it is open, or from an entry, outwards. A ring is a step further along
/// the cleared places than the one before: what a cutter there removes is at most that far from what was removed,
/// so it is as wide as the step. A pass along the borders of the places that can be reached ends the level. `link`:
/// length up to which a path through what is cleared is quicker than to retract. Levels do not depend on each other.
LevelRuns level_runs(const LevelScene& scene, double z, double least, double link);

}  // namespace riffler::plan
