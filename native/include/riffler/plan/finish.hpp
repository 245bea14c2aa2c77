// Finishing in three axes: rows on a part's offset surface, with the links between them, as one operation.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// What an operation works on: one frame, mm.
struct SetupScene {
  Mesh part;
  std::vector<Mesh> fixtures;
  Volume stock;          ///< at the beginning of the operation
  Vec3 axis{0, 0, 1};    ///< unit vector from tip to spindle
  double clearance = 5;  ///< mm above part, stock and fixtures along the axis: rapids across happen there
};

/// Options of finish.
struct FinishOptions {
  std::string pattern = "parallel";                      ///< one of `finish_patterns`
  double cusp = 0.01;                                    ///< mm, largest height of what stays between rows
  double tolerance = 0.005;                              ///< mm, of the rows: above and below the offset surface
  double allowance = 0;                                  ///< mm that stay on the part
  double angle = 0;                                      ///< rad, of the rows about the axis
  double min_slope = 0, max_slope = 1.5707963267948966;  ///< rad from level, of the faces that are meant
  std::vector<std::vector<Vec3>> region{};               ///< closed curves, seen along the axis; empty: all of the part
  double feed = 1000;                                    ///< mm/min of cuts and links
  double plunge = 300;                                   ///< mm/min of leads
};

/// What a row of an operation is.
enum class MoveKind : std::uint8_t { Rapid, Lead, Cut, Link };

/// Why and where the tool does not cut.
struct BlockedPlace {
  std::string reason;
  Vec3 place{0};      ///< tip of the tool at the first of these places, mm
  double length = 0;  ///< mm of rows that are left out
};

/// An operation: it begins and ends on the clearance plane.
struct FinishResult {
  std::vector<Pose> poses;
  std::vector<MoveKind> kinds;  ///< of the move that ends at the pose
  std::vector<double> feeds;    ///< mm/min; 0 for rapids
  std::vector<BlockedPlace> blocked;
  std::string reason;  ///< why there are no poses; empty if there are some
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
