// Moves an operation that was planned on triangles onto the exact surface that the triangles approximate.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/operation.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// Distances of a fit, mm.
struct SurfaceFitRule {
  double clearance = 0;      ///< of the tool from the surface where it cuts: the operation's allowance
  double tolerance = 0.005;  ///< of the moves between two poses, above and below
  double deviation = 0;      ///< of the triangles from the surface
  bool level = false;        ///< whether poses keep their heights, where the surface is not level
};

/// Counts and distances of a fit.
struct SurfaceFit {
  std::size_t fitted = 0;    ///< poses at which the tool touches the surface
  std::size_t inserted = 0;  ///< poses added between those of the operation
  std::size_t raised = 0;    ///< poses without such a place near them, raised until the tool is free
  std::size_t kept = 0;      ///< poses left as they were, because no place near them is free or touches
  double before = 0;         ///< largest distance of the tool from its place at a fitted pose, before
  double after = 0;          ///< largest one after the fit, also in the middles of moves
  double kept_depth = 0;     ///< largest depth of the tool in the surface at a kept pose
  Vec3 kept_at{0};           ///< its tip
};

/// Corrects the poses of cuts and of links at feed in which the tool is as near to the surface as the triangles'
/// deviation explains: along the tool's axis, or square to it on steep faces, until the exact distance of cutter, shank
/// and holder from the whole surface is `clearance` within 1e-6 mm. So no neighbouring face is cut either. Other poses
/// at feed are raised if they cut into the surface. The middle of each move is checked likewise, and divides the move
/// until it is within the tolerance. `exact`: the surface. No corrected pose comes nearer to `fixtures`
/// than `clearance`, or than before.
SurfaceFit fit_to_surface(Operation& moves, const Tool& tool, const collide::Collider& exact,
                          const std::vector<Mesh>& fixtures, const SurfaceFitRule& rule, const Progress& progress = {});

}  // namespace riffler::plan
