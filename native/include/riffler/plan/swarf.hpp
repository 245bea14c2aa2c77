// Swarf cuts: the cutter's flank along a wall, its end in the pencil path at the wall's foot.
#pragma once

#include <optional>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/plan/path.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

struct SwarfOptions {
  int side = 0;                  ///< which of the path's contacts is the wall's: 0 or 1
  std::optional<double> height;  ///< most of the wall, from the ball's centre, mm; else as far as flank and wall go
  double tolerance = 0.05;       ///< the flank lies within this of the wall, mm
};

/// A wall cut by the flank.
struct Swarf {
  PencilPath path;  ///< with axes
  /// At each point, mm: along the axis from the ball's centre, up to which there is wall, and the largest distance
  /// between flank and wall up to there; infinity where nothing stands.
  std::vector<double> height, error;
  /// Runs of points where the flank fits, [first, last].
  std::vector<std::array<std::size_t, 2>> fits;
};

/// Where the wall is ruled, the axis through the ball's centre along which the flank touches it all the way up: among
/// all directions square to the wall's normal that which leaves the least error, with the upper end of the flank made
/// to touch too, so that what twists is shared between both ends (two-point offset: Bedi, Mann & Menzel, Computer-Aided
/// Design 35 (2003) 293, roll between guide curves so). The flank must be a cylinder or cone above the ball's centre.
/// std::invalid_argument: a side other than 0 and 1, a height or tolerance that is not positive or beyond the cutter, a
/// cutter without ball end of the path's radius, an empty path or part.
Swarf swarf(const PencilPath& path, const Mesh& part, const Tool& tool, const SwarfOptions& options = {},
            const Progress& progress = {});

}  // namespace riffler::plan
