// Outlines: a part's silhouette, or closed curves, cut out at the cutter's radius, with tabs, as one operation.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of outline.
struct OutlineOptions {
  std::vector<std::vector<Vec3>> curves{};  ///< closed curves; empty: the part's silhouette
  bool inside = false;      ///< true: the tool runs within the curves; false: around them and in their holes
  double depth = 0;         ///< mm below the highest point of part or curves; 0: down to the underside of the stock
  double stepdown = 2;      ///< height of a layer, mm
  std::size_t tabs = 0;     ///< number of bridges that stay along each loop
  double tab_height = 1;    ///< height of a bridge above the lowest layer, mm
  double tab_width = 4;     ///< length of a bridge along the loop, mm
  double allowance = 0;     ///< thickness of the material that stays on the part, mm
  double tolerance = 0.01;  ///< mm by which loops may lie outside of the exact offset; they never lie inside
  double slope = 0.05;      ///< slope of ramps, rad
  bool climb = true;        ///< whether the part lies to the right of the motion
  double feed = 1000;       ///< feed of cuts, mm/min
  double plunge = 300;      ///< feed of leads, mm/min
  std::optional<double> lead{};  ///< radius of the arcs into cuts and out of them, mm; 0 makes no arcs; without a
                                 ///< value, half the cutter's radius
};

/// The operation, and counts of loops cut, layers in them, tabs that stay, links over the clearance plane, leads that
/// are arcs, and leads that are straight because no arc fits.
struct OutlineResult : Operation {
  std::size_t loops = 0, levels = 0, tabs = 0, retracts = 0, arcs = 0, straight = 0;
};

/// Plans one operation. The cutter's axis keeps the cutter's radius + allowance from silhouette or curves. The
/// operation leaves out holes that are too narrow for the cutter, and stretches where part, shank, holder or a fixture
/// obstruct the tool; `blocked` lists both. Throws std::invalid_argument naming the option.
OutlineResult outline(const SetupScene& scene, const Tool& tool, const OutlineOptions& options,
                      const Progress& progress = {});

}  // namespace riffler::plan
