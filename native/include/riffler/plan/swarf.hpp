// Swarf cuts: the cutter's flank follows a wall, its end the pencil path at the wall's foot.
#pragma once

#include <optional>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/mesh/mesh.hpp"
#include "riffler/plan/path.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Options of swarf.
struct SwarfOptions {
  int side = 0;                  ///< index of the path's contact that lies on the wall: 0 or 1
  std::optional<double> height;  ///< mm, wall height from the ball's centre; default: to the end of flank or wall
  double tolerance = 0.05;       ///< largest distance between flank and wall, mm
};

/// A wall to be cut by the flank.
struct Swarf {
  PencilPath path;  ///< with axes
  /// Per point, mm: height of the wall along the axis from the ball's centre, and the largest distance between flank
  /// and wall up to that height; infinity where there is no wall.
  std::vector<double> height, error;
  /// Runs of points where the flank is within the tolerance, [first, last].
  std::vector<std::array<std::size_t, 2>> fits;
};

/// For a ruled wall, the axis through the ball's centre along which the flank touches the wall over its whole height.
/// Among the directions orthogonal to the wall's normal it takes the one with the smallest error, with the upper end of
/// the flank also made to touch, so that twist is shared between both ends (two-point offset: Bedi, Mann & Menzel,
/// Computer-Aided Design 35 (2003) 293, who roll between guide curves). The flank must be a cylinder or cone above the
/// ball's centre. Throws std::invalid_argument for a side other than 0 and 1, a height or tolerance that is not
/// positive or exceeds the cutter, a cutter without a ball end of the path's radius, an empty path or an empty part.
Swarf swarf(const PencilPath& path, const Mesh& part, const Tool& tool, const SwarfOptions& options = {},
            const Progress& progress = {});

}  // namespace riffler::plan
