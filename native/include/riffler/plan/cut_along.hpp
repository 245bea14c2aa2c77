// Operations along given poses: collisions, leads and links of cuts whose axes may change.
#pragma once

#include <optional>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// A line of poses to be cut in order.
struct CutLine {
  std::vector<Pose> poses;
  std::vector<MoveKind> kinds{};  ///< Cut or Link, of the move to each pose; empty: all Cut
};

/// Options of cut_along.
struct CutAlongOptions {
  double distance = 0;      ///< of cutter, shank and holder from the part, mm; negative: the cut's depth
  double tolerance = 0.01;  ///< by which the distance may be less, mm
  double max_lift = 0;      ///< largest lift of a pose along its axis that frees it, mm; other poses are left out
  double feed = 1000;       ///< of cuts and links, mm/min
  double plunge = 300;      ///< of leads, mm/min
  std::optional<double> fixture_distance{};  ///< of cutter, shank and holder from fixtures, mm; none: `distance`
};

/// The operation, and counts.
struct CutAlongResult : Operation {
  std::size_t pieces = 0;    ///< lines and parts of lines that are cut
  std::size_t retracts = 0;  ///< links over the clearance plane
  std::size_t lifted = 0;    ///< poses that were lifted
};

/// Cuts lines of poses, whose axes lean by at most `kMaxTilt` from the set-up's.
///
/// Poses are lifted, and moves between them proven free, by cutter_locations; what no lift frees is left out and listed
/// in `blocked`. Where fixtures have a distance of their own, moves are not lifted off them but end there. For each
/// piece that remains, the tool comes down and leaves along its own axis, or, where part, fixtures or stock obstruct
/// cutter, shank or holder, in another direction; every lead is proven free of part and fixtures by the same bound as
/// the cuts, and shank and holder also of the stock as it was before the operation. A piece that no lead reaches is
/// left out as well. Between pieces the tool moves and turns above part, fixtures and the stock's box, where no part of
/// it is below the clearance plane. The operation begins and ends there, along the set-up's axis. Throws
/// std::invalid_argument for options, and naming line and pose for poses that are not finite or lean further.
CutAlongResult cut_along(const SetupScene& scene, const Tool& tool, const std::vector<CutLine>& lines,
                         const CutAlongOptions& options, const Progress& progress = {});

}  // namespace riffler::plan
