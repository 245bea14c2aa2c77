// Roughing in layers, with a bounded width of cut, as one operation.
#pragma once

#include <cstddef>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of rough.
struct RoughOptions {
  double stepdown = 2;      ///< mm, height of a layer
  double engagement = 0.4;  ///< largest width of cut as a share of the cutter's diameter
  double allowance = 0.3;   ///< mm that stay on the part
  double tolerance = 0.05;  ///< mm, of curves
  double slope = 0.05;      ///< rad, of helices and ramps
  bool climb = true;        ///< whether material lies to the right of the motion
  double feed = 1000;       ///< mm/min of cuts and links
  double plunge = 300;      ///< mm/min of leads
};

/// The operation, and counts.
struct RoughResult : Operation {
  double engagement = 0;  ///< largest width of cut of cutting moves as a share of the diameter
  /// Layers with material, rings in them, entries by a helix and by a ramp to and fro, links at feed, links over the
  /// clearance plane, and points of the drop surface computed.
  std::size_t levels = 0, rings = 0, helices = 0, ramps = 0, direct = 0, retracts = 0, drops = 0;
};

/// Plans one operation: clears the stock as it stands in layers, from above, wherever the whole tool does not meet part
/// + allowance or fixtures. No cut or link is below part + allowance, by a bound (DropCutter::rise). Moves that cut
/// wider than asked for, where a narrow slot is entered, are leads. Throws std::invalid_argument naming the option, and
/// for a cutter that narrows above its widest place.
RoughResult rough(const SetupScene& scene, const Tool& tool, const RoughOptions& options,
                  const Progress& progress = {});

}  // namespace riffler::plan
