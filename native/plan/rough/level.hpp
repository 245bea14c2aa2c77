// One level of roughing: the cutter's moves at one height.
#pragma once

#include <optional>
#include <vector>

#include "plan/contours.hpp"
#include "plan/rough/entry.hpp"
#include "plan/rough/layer.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/plan/operation.hpp"

namespace riffler::plan {

/// Data that all levels share. Lengths in mm, in the rows' frame.
struct LevelScene {
  const PlaceGrid& grid;
  const Field& heights;       ///< of the drop surface at the places; −∞ where the tool touches nothing
  const Field& ground;        ///< of part and fixtures + allowance over the cells; −∞ where both are absent
  const DropCutter& surface;  ///< the drop surface itself
  const DropCutter& floor;    ///< the surface that no move may go below; nowhere higher than `surface`
  const StockTops& stock;     ///< before the first level: higher levels change it only above this level
  double radius;              ///< of the cutter at the top of a layer
  double widest_radius;       ///< largest radius of the cutter
  double step;                ///< distance between two rings
  double widest;              ///< requested largest width of cut
  double ramp;                ///< length along which a pass reaches its full width
  double helix;               ///< radius of a helix that has enough room
  double slot;                ///< length of a ramp that has enough room, where a helix has not
  double sliver;              ///< material thinner than this at a wall gets no pass: the stock is no more exact
  double tolerance;           ///< largest error of curves
  bool climb;                 ///< whether material lies to the right of the motion
};

/// Tips of the cutter, and the kind of the move to each. A move that goes deeper than those before, or cuts too wide,
/// is a lead. The first tip is free of material, or equals the last tip of the previous run, or is the end of an entry.
struct LevelRun {
  std::vector<Vec3> tips;
  std::vector<MoveKind> kinds;
  std::vector<double> rises;   ///< height of the floor above the move to each tip, mm
  std::optional<Entry> entry;  ///< how the cutter comes down to the first tip
  bool linked = false;         ///< whether it begins where the previous run ends
};

/// The runs of one level, in order.
struct LevelRuns {
  std::vector<LevelRun> runs;
  double widest = 0;  ///< largest width of the cuts, mm
  std::size_t rings = 0, entries = 0;
  std::vector<Vec3> narrow;  ///< the widest place of each area left out because it is too narrow for any entry
  std::vector<Vec3> holes;   ///< a place in each area with stock that is too narrow for the cutter
};

/// Clears the layer above height `z`, outwards from its open sides or from an entry. Each ring is one step further,
/// along paths within the permitted places, than the ring before. The material that it removes is therefore at most one
/// step from the cleared area, and the cut at most one step wide. A pass along the borders of the reachable places ends
/// the level. `least`: material less high above `z` than this stays, mm. `link`: a path through the cleared area that
/// is shorter than this is quicker than a retract, mm. Levels do not depend on each other.
LevelRuns level_runs(const LevelScene& scene, double z, double least, double link);

}  // namespace riffler::plan
