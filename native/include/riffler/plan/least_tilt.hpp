// Collision-free tool axes along a path with the smallest tilt.
#pragma once

#include <string>
#include <vector>

#include "riffler/plan/orientation_map.hpp"

namespace riffler::plan {

/// Rule of the search for tool axes.
struct TiltRule {
  MapRule map;
  /// Largest angle between the axes of neighbouring points, rad. Must not be smaller than the grid's steps can satisfy.
  double max_change = 0.3;
  /// Weight of (angle between neighbours)² relative to (angle between axis and frame z)².
  double smoothness = 4;
};

/// The axes found, or why there are none.
struct TiltAnswer {
  bool found = false;
  std::vector<Vec3> axes;      ///< one per point, where found
  std::vector<double> angles;  ///< angle from the frame's z, rad
  double cost = 0;             ///< Σ angle² + smoothness Σ change²
  /// If nothing was found: the first point without a free axis, or whose free axes cannot be reached within
  /// `max_change` from the points before it, and the reason.
  std::size_t point = 0;
  std::string reason;
};

/// Chooses one free node of every point's orientation map. Minimises the sum of squared angles between axis and frame z
/// plus `smoothness` times the sum of squared changes between neighbours, with no change above `max_change`. Dynamic
/// programming over the points, exact over the grid. A closed path also counts last and first point as neighbours. The
/// axis of its first point is taken from the middle of the best two-lap round; if no lap closes with it, the first axis
/// that closes is taken, in ascending cost of the open path. The lap is then the best for that start. cutter_locations
/// checks the moves between points. Errors as orientation_maps.
TiltAnswer least_tilt(const PencilPath& path, const collide::Assembly& assembly, const collide::Collider& collider,
                      const TiltRule& rule, const Progress& progress = {});

}  // namespace riffler::plan
