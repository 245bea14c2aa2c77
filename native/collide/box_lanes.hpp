// How much of small boxes is in a tool, in vector lanes, chosen at run time.
#pragma once

#include <span>

#include "collide/outline_lanes.hpp"
#include "collide/sphere_tree.hpp"
#include "collide/tool_frame.hpp"

namespace riffler::collide {

/// Half the sides of boxes along the part's directions, mm, and the volume of material in each, mm³. Their middles are
/// those of the spheres round them.
struct alignas(64) BoxGroup {
  double half[3][base::kLanes]{}, volume[base::kLanes]{};
};

/// What of each box is in the tool.
struct BoxShares {
  double distance[base::kLanes];   ///< of its middle, mm
  double share[base::kLanes];      ///< of its volume
  double rise[base::kLanes];       ///< by which the share grows where the tool comes nearer, 1/mm
  double normal[3][base::kLanes];  ///< of the tool there, along the part's directions
};

/// The tool is to a box what its tangent plane is: the half-space at the distance of the box's middle, square to the
/// way to the nearest place of the outline. The share is then exact but for the shortest of its three widths, along
/// which two places stand for all: as continuous in the pose as distances are, with a continuous derivative but for
/// faces that come on flat, and shares of neighbours add up to that of both.
void box_shares(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                const BoxGroup& boxes, BoxShares& out);

}  // namespace riffler::collide
