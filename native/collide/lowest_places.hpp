// The lowest places of several triangles at a time, in vector lanes chosen at run time.
#pragma once

#include <span>

#include "collide/outline_lanes.hpp"

namespace riffler::collide {

/// The lowest places found on triangles.
struct LanePlaces {
  double low[base::kLanes];                                  ///< lower bounds, mm
  double distance[base::kLanes];                             ///< signed distances at the places, mm
  double x[base::kLanes], y[base::kLanes], z[base::kLanes];  ///< relative to the tip, in part directions
};

/// Searches each triangle for its lowest place by steps of Newton's method, and raises places.low by the tangent planes
/// there: on a convex part of the tool they meet the distance at its minimum. A triangle is finished when its bound is
/// within `slack` of the distance found or not below `enough` (mm); the last of a few steps leaves the others open.
void lowest_places(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                   const Corners* triangles, double enough, double slack, LanePlaces& places);

}  // namespace riffler::collide
