// Finishing in three axes: rows on a part's offset surface, with the links between them, as one operation.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of finish.
struct FinishOptions {
  std::string pattern = "parallel";                      ///< one of `finish_patterns`
  double cusp = 0.01;                                    ///< mm, largest height of what stays between rows
  double tolerance = 0.005;                              ///< mm, of the rows: above and below the offset surface
  double allowance = 0;                                  ///< mm that stay on the part
  double angle = 0;                                      ///< rad, of the rows about the axis
  double min_slope = 0, max_slope = 1.5707963267948966;  ///< rad from level, of the faces that are meant
  std::vector<std::vector<Vec3>> region{};               ///< closed curves, seen along the axis; empty: all of the part
  std::vector<int> faces{};                              ///< triangles of the part that are meant; empty: all
  std::optional<Vec3> centre{};                          ///< of spiral and radial; none: the middle of the part's box
  bool climb = true;                                     ///< waterline: the part lies to the right of the motion
  double feed = 1000;                                    ///< mm/min of cuts and links
  double plunge = 300;                                   ///< mm/min of leads
};

/// The operation, and counts.
struct FinishResult : Operation {
  /// Rows cut, rows added between those of equal spacing, links at feed, links over the clearance plane, and points of
  /// the offset surface computed.
  std::size_t rows = 0, added = 0, direct = 0, retracts = 0, drops = 0;
};

/// The names of the patterns.
std::vector<std::string> finish_patterns();

/// Plans one operation. Rows are curves of the exact drop surface of the whole tool over part and fixtures: no point of
/// a cut or link is more than `tolerance` below it, by a bound (DropCutter::rise). Rows end where the tool leaves the
/// part: a wall without a floor next to it is left to an outline. Throws std::invalid_argument naming the option, and
/// for a cutter that stands on its side or has an undercut as its widest place.
FinishResult finish(const SetupScene& scene, const Tool& tool, const FinishOptions& options,
                    const Progress& progress = {});

}  // namespace riffler::plan
