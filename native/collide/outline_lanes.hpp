// Signed distances of several points at a time from a tool's outline, and bounds for those of triangles, in vector
// lanes, chosen at run time.
#pragma once

#include <span>

#include "collide/drift.hpp"
#include "collide/outline_runs.hpp"
#include "collide/sphere_tree.hpp"
#include "collide/tool_frame.hpp"
#include "collide/triangle_search.hpp"
#include "riffler/tool/outline.hpp"

namespace riffler::collide {

/// An edge of an outline with what its distances need.
struct LaneEdge {
  double from[2], to[2], way[2], per_square;  // way = to − from, per_square = 1 / way²
  double normal[2];                           // of a line, out of the solid
  double centre[2], first[2], last[2];        // of an arc; ends from the centre times side
  double radius, side;                        // of an arc; side: 1 bulges, −1 is a hollow
  bool arc, rises;

  explicit LaneEdge(const tool::OutlineEdge& e);
};

/// distance[k] = that of the centre of sphere k, mm, negative inside: Outline::nearest to rounding.
void centre_distances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                      double* distance);

/// low[k]: no point of triangle k, round which sphere k is, is nearer or deeper than this. By the sphere, and by a
/// tangent plane of every run (outline_runs.hpp): all of the run's solid lies behind it, so it bounds the distance
/// outside of the tool; inside, the depth, if all that is near has its feet on the run and not beyond its ends. A
/// hollow has a ball instead, of use outside only. With a `drift`, in the part's directions: at no time of that
/// stretch.
void triangle_bounds(const OutlineRuns& runs, std::span<const LaneEdge> outline, const ToolFrame& frame,
                     const SphereGroup& spheres, const Corners* triangles, const Drift* drift, const double* distance,
                     double* low);

}  // namespace riffler::collide
