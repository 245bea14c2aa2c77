// Signed distances of several points at a time from a tool's outline, and lower bounds for triangles, in vector lanes
// chosen at run time.
#pragma once

#include <span>

#include "collide/drift.hpp"
#include "collide/oriented_boxes.hpp"
#include "collide/outline_runs.hpp"
#include "collide/sphere_tree.hpp"
#include "collide/tool_frame.hpp"
#include "collide/triangle_search.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::collide {

/// An edge of an outline with precomputed data for distances.
struct LaneEdge {
  double from[2], to[2], way[2], per_square;  // the third is to − from, the last 1 over its square
  double normal[2];                           // of a line, pointing out of the solid
  double centre[2], first[2], last[2];        // of an arc; first, last: ends relative to the centre, times side
  double radius, side;                        // of an arc; side: 1 convex, −1 hollow
  bool arc, rises;

  explicit LaneEdge(const tool::OutlineEdge& e);
};

/// distance[k]: signed distance of the centre of sphere k, mm, negative inside. Equals Outline::nearest up to rounding.
void centre_distances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                      double* distance);

/// low[k]: lower bound of the signed distance over triangle k, which sphere k encloses. It comes from the sphere and
/// from a tangent plane of every run (outline_runs.hpp). The run's whole solid is behind the plane, so the plane bounds
/// the distance outside the tool; inside, it bounds the depth if the nearest points of all points of the triangle are
/// on the run and not beyond its ends. A hollow has a ball instead of a plane, which is useful only outside. With a
/// `drift` (in part directions), the bound holds throughout the interval.
void triangle_bounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                     const SphereGroup& spheres, const Corners* triangles, const Drift* drift, const double* distance,
                     double* low);

/// low[k] and high[k]: lower and upper bound of the smallest signed distance in box k, from its sphere and from tangent
/// planes as in triangle_bounds. With `drift`, low[k] holds throughout the interval. For a box without extent, both are
/// the distance of its centre.
void box_bounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                const OrientedBoxes& boxes, const Drift* drift, double* low, double* high);

}  // namespace riffler::collide
