// Finishing: rows on a part's offset surface, with the links between them, as one operation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/plan/axis_rule.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of finish.
struct FinishOptions {
  std::string pattern = "parallel";                      ///< one of `finish_patterns`
  double cusp = 0.01;                                    ///< largest height of the ridges between rows, mm
  double tolerance = 0.005;                              ///< largest distance of rows from the offset surface, mm
  double allowance = 0;                                  ///< thickness of the material that stays on the part, mm
  double angle = 0;                                      ///< direction of the rows about the axis, rad
  double min_slope = 0, max_slope = 1.5707963267948966;  ///< slopes of the faces to finish, rad from level
  std::vector<std::vector<Vec3>> region{};  ///< closed curves around faces, seen along the axis; empty: all
  std::vector<int> faces{};                 ///< indices of the part's triangles to finish; empty: all
  std::optional<Vec3> centre{};             ///< of spiral and radial, mm; none: middle of the part's box
  bool climb = true;                        ///< waterline: whether the part lies to the motion's right
  double feed = 1000;                       ///< feed of cuts and links, mm/min
  double plunge = 300;                      ///< feed of leads, mm/min
  std::optional<double> lead{};    ///< radius of the arcs into cuts and out of them, mm; 0 makes no arcs; without a
                                   ///< value, half the cutter's radius
  std::optional<AxisRule> axes{};  ///< of axes that change along the rows; none: all along the set-up's
};

/// The operation, and counts.
struct FinishResult : Operation {
  /// Numbers of rows cut, rows added between those of equal spacing, links at feed, links over the clearance plane,
  /// leads that are arcs, leads that are straight because no arc fits, and computed points of the offset surface.
  std::size_t rows = 0, added = 0, direct = 0, retracts = 0, arcs = 0, straight = 0, drops = 0;
};

/// The names of the patterns.
std::vector<std::string> finish_patterns();

/// Plans one operation. Rows are curves of the exact drop surface of the whole tool over part and fixtures: no point of
/// a cut or link is more than `tolerance` below it, by a bound (DropCutter::rise). Rows end where the tool leaves the
/// part: a wall without a floor next to it needs an outline instead. With the option `axes`, rows are those of the ball
/// at the tool's tip, whose centre follows them while the axis turns (cut_along.hpp); the tool's leads are then
/// straight. Throws std::invalid_argument naming the option,
/// and for a cutter that stands on its side or has an undercut as its widest place.
FinishResult finish(const SetupScene& scene, const Tool& tool, const FinishOptions& options,
                    const Progress& progress = {});

}  // namespace riffler::plan
