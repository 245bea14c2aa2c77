// The machining configuration space at a point of a path (4.1): which tool axes are free of collision.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "riffler/plan/orientation.hpp"

namespace riffler::plan {

/// Grid and limits of an orientation map.
struct MapRule {
  std::vector<double> inclinations, tilts;  ///< rad, ascending; the grid
  double clearance = 0;                     ///< wanted clearance to part and fixtures, mm
  double tolerance = 0.01;         ///< mm; a clearance lower by up to this counts as free, since the cutter must touch
  std::optional<AxisLimit> limit;  ///< the machine's cone; nothing is computed outside it
  bool clearances = true;          ///< false: compute states only, much faster; clearances are NaN
};

/// Throws std::invalid_argument naming the field that is not finite, not ascending or out of range.
void validate(const MapRule& rule);

/// One entry per node of the grid, row-major: inclinations × tilts.
struct OrientationMap {
  /// State of one tool axis.
  enum class State : unsigned char {
    Free,
    Blocked,
    Beyond,      ///< outside the machine's cone
    Unreachable  ///< the cutter cannot touch the contacts with this axis
  };
  CcFrame frame;
  std::vector<Vec3> axes;
  std::vector<double> clearance;  ///< mm, signed; NaN where beyond or unreachable
  std::vector<State> state;
  std::vector<collide::Touch> touch;  ///< the nearest or deepest contact

  /// Index of the free axis nearest to the frame's z, the first of equals; no value if none is free.
  std::optional<std::size_t> least_tilt() const;
  /// "" if some axis is free; otherwise what blocks the axis that is closest to being free.
  std::string why_none() const;
};

/// The maps at the given points of the path, about the frames of frame_at, with the tool placed by location_on_path.
/// Throws std::invalid_argument as validate, and for a point index outside the path. Parallel over points and
/// orientations.
std::vector<OrientationMap> orientation_maps(const PencilPath& path, const std::vector<std::size_t>& points,
                                             const collide::Assembly& assembly, const collide::Collider& collider,
                                             const MapRule& rule, const Progress& progress = {});

}  // namespace riffler::plan
