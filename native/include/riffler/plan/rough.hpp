// Roughing in layers, with a bounded width of cut, as one operation.
#pragma once

#include <cstddef>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of rough.
struct RoughOptions {
  double stepdown = 2;      ///< height of a layer, mm
  double engagement = 0.4;  ///< largest width of cut as a share of the cutter's diameter
  double allowance = 0.3;   ///< thickness of the material that stays on the part, mm
  double tolerance = 0.05;  ///< largest error of curves, mm
  double slope = 0.05;      ///< slope of helices and ramps, rad
  bool climb = true;        ///< whether material lies to the right of the motion
  double feed = 1000;       ///< feed of cuts and links, mm/min
  double plunge = 300;      ///< feed of leads, mm/min
  double depth = 0;         ///< of the lowest layer below the part's highest point, mm; 0: down to part or stock
};

/// The operation, and counts.
struct RoughResult : Operation {
  double engagement = 0;  ///< largest width of cut of cutting moves as a share of the diameter
  /// Numbers of layers with material, rings in them, entries by a helix and by a ramp to and fro, links at feed, links
  /// over the clearance plane, and computed points of the drop surface.
  std::size_t levels = 0, rings = 0, helices = 0, ramps = 0, direct = 0, retracts = 0, drops = 0;
};

/// Plans one operation: clears the remaining stock in layers, from above, wherever the whole tool stays clear of part +
/// allowance and fixtures. No cut or link is below part + allowance, by a bound (DropCutter::rise). Moves that cut
/// wider than `engagement`, as where the tool enters a narrow slot, are leads. Throws std::invalid_argument naming the
/// option, and for a cutter that narrows above its widest place.
RoughResult rough(const SetupScene& scene, const Tool& tool, const RoughOptions& options,
                  const Progress& progress = {});

}  // namespace riffler::plan
