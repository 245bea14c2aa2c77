// Signed distances of several points at a time from a tool's outline, in vector lanes, chosen at run time.
#pragma once

#include <span>

#include "collide/sphere_tree.hpp"
#include "collide/tool_frame.hpp"
#include "tool/outline.hpp"

namespace riffler {

/// An edge of an outline with what its distances need.
struct LaneEdge {
  double from[2], to[2], way[2], per_square;  // way = to − from, per_square = 1 / way²
  double centre[2], first[2], last[2];        // of an arc; ends from the centre times side
  double radius, side;                        // of an arc; side: 1 bulges, −1 is a hollow
  bool arc, rises;

  explicit LaneEdge(const OutlineEdge& e);
};

/// distance[k] = that of the centre of sphere k, mm, negative inside: Outline::nearest to rounding.
void centre_distances(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                      double* distance);

}  // namespace riffler
