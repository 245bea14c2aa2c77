// Outlines: a part's silhouette, or closed curves, cut out at the cutter's radius, with tabs, as one operation.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of outline.
struct OutlineOptions {
  std::vector<std::vector<Vec3>> curves{};  ///< closed; empty: the part's silhouette
  bool inside = false;      ///< whether the tool runs within the curves; around them, and in their holes, otherwise
  double depth = 0;         ///< mm below the part's, or the curves', highest point; 0: to the underside of the stock
  double stepdown = 2;      ///< mm, height of a layer
  std::size_t tabs = 0;     ///< bridges that stay along each loop
  double tab_height = 1;    ///< mm above the lowest layer
  double tab_width = 4;     ///< mm of a bridge along the loop
  double allowance = 0;     ///< mm that stay on the part
  double tolerance = 0.01;  ///< mm, of the loops: outside of the offset by at most that, and never inside
  double slope = 0.05;      ///< rad, of ramps
  bool climb = true;        ///< whether the part lies to the right of the motion
  double feed = 1000;       ///< mm/min of cuts
  double plunge = 300;      ///< mm/min of leads
};

/// The operation, and counts: loops cut, layers in them, tabs that stand, links over the clearance plane.
struct OutlineResult : Operation {
  std::size_t loops = 0, levels = 0, tabs = 0, retracts = 0;
};

/// Plans one operation. The cutter's axis keeps its radius + allowance from silhouette or curves. Holes that it does
/// not fit into, and stretches where part, shank, holder or a fixture stand there, are left out and are in
/// `blocked`. Throws std::invalid_argument naming the option.
OutlineResult outline(const SetupScene& scene, const Tool& tool, const OutlineOptions& options,
                      const Progress& progress = {});

}  // namespace riffler::plan
