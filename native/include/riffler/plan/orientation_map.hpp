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

struct MapRule {
  std::vector<double> inclinations, tilts;  ///< rad, ascending; the grid
  double clearance = 0;                     ///< wanted over part and fixtures, mm
  double tolerance = 0.01;         ///< less than `clearance` by this counts as free: the cutter is to touch, mm
  std::optional<AxisLimit> limit;  ///< the machine's cone; nothing is computed beyond it
  bool clearances = true;          ///< otherwise only states, much quicker, and every clearance is NaN
};

/// Throws std::invalid_argument naming what is not finite, not ascending or out of range.
void validate(const MapRule& rule);

/// Row-major: inclinations × tilts.
struct OrientationMap {
  enum class State : unsigned char {
    Free,
    Blocked,
    Beyond,      ///< the machine's cone
    Unreachable  ///< the cutter cannot touch there from this side
  };
  CcFrame frame;
  std::vector<Vec3> axes;
  std::vector<double> clearance;  ///< mm, signed; NaN where beyond or unreachable
  std::vector<State> state;
  std::vector<collide::Touch> touch;  ///< what is nearest, or deepest

  /// The free axis nearest to the frame's z, the first of equals; nothing where none is free.
  std::optional<std::size_t> least_tilt() const;
  /// "" where some axis is free; otherwise what is in the way of the one that comes nearest to being so.
  std::string why_none() const;
};

/// The maps at some points of the path, about the frames of frame_at; the tool stands as by location_on_path.
/// std::invalid_argument as by validate, and naming a point that the path has not. Parallel over points and
/// orientations.
std::vector<OrientationMap> orientation_maps(const PencilPath& path, const std::vector<std::size_t>& points,
                                             const collide::Assembly& assembly, const collide::Collider& collider,
                                             const MapRule& rule, const Progress& progress = {});

}  // namespace riffler::plan
