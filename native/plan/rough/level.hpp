// One level of roughing: where the cutter moves at one height.
#pragma once

#include <vector>

#include "plan/contours.hpp"
#include "plan/rough/layer.hpp"
#include "riffler/plan/drop.hpp"
#include "riffler/plan/operation.hpp"

namespace riffler::plan {

/// What all levels share; lengths in mm, in the rows' frame.
struct LevelScene {
  const PlaceGrid& grid;
  const Field& heights;       ///< of the drop surface over the places; −∞ where the tool touches nothing
  const DropCutter& surface;  ///< the drop surface itself
  double radius;              ///< of the cutter where a layer is cut
  double step;                ///< between a ring and the next
  double widest;              ///< width of cut that is asked for
  double ramp;                ///< length along which a pass goes to its full width
  double helix;               ///< radius of a helix with room
  double slope;               ///< rad, of helices
  double sliver;              ///< thickness of material at a wall that is not worth a pass: the stock is no more exact
  double tolerance;           ///< of curves
  bool climb;                 ///< whether material lies to the right of the motion
};

/// Tips of the cutter and the kinds of the moves that end there; the first one is free of material. A move that
/// goes deeper than before, or cuts wider than asked for, is a lead.
struct LevelRun {
  std::vector<Vec3> tips;
  std::vector<MoveKind> kinds;
  double top = 0;       ///< of the stock under the first one, mm
  bool linked = false;  ///< whether a straight line at this height leads from the last tip of the run before
};

/// The runs of one level, in their order.
struct LevelRuns {
  std::vector<LevelRun> runs;
  double widest = 0;  ///< width of the cuts, mm
  std::size_t rings = 0, helices = 0, plunges = 0;
  Vec3 plunge{0};  ///< where the first one is
};

/// Clears the layer above height `z` from where it is open, or from a helix, outwards. A ring is a step further along
/// the cleared places than the one before: what a cutter there removes is at most that far from what was removed,
/// so it is as wide as the step. A pass along the borders of the places that can be reached ends the level. Takes what
/// it cuts off `tops`.
LevelRuns level_runs(const LevelScene& scene, double z, double least, StockTops& tops);

}  // namespace riffler::plan
