// The free tool axes along a path that lean least.
#pragma once

#include <string>
#include <vector>

#include "riffler/plan/orientation_map.hpp"

namespace riffler::plan {

struct TiltRule {
  MapRule map;
  /// Largest angle between the axes of neighbouring points, rad. It cannot be less than what the grid's steps allow to
  /// be chosen between.
  double max_change = 0.3;
  /// Weight of (angle between neighbours)² against (angle between axis and the frame's z)².
  double smoothness = 4;
};

struct TiltAnswer {
  bool found = false;
  std::vector<Vec3> axes;      ///< one per point, where found
  std::vector<double> angles;  ///< from the frame's z, rad
  double cost = 0;             ///< Σ angle² + smoothness Σ change²
  /// Otherwise: the first point at which no axis is free, or that none of its free axes reaches within `max_change`
  /// from those before it, and why.
  std::size_t point = 0;
  std::string reason;
};

/// Chooses one free node of every point's map so that the sum of the squared angles between axis and frame z, plus
/// `smoothness` times that of the squared changes between neighbours, is least, no change above `max_change`: dynamic
/// programming over the points, exact over the grid. On a loop the last and first point are neighbours too: the axis of
/// the first point is the one that the best round trip in the middle of two laps has, or, if no round closes with it,
/// the first that one does by ascending cost of the open path; the round is then the best for that start.
/// What happens between points is for cutter_locations to check.
TiltAnswer least_tilt(const PencilPath& path, const collide::Assembly& assembly, const collide::Collider& collider,
                      const TiltRule& rule, const Progress& progress = {});

}  // namespace riffler::plan
