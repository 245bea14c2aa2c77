// Fraction of small boxes that lies inside a tool, in vector lanes chosen at run time.
#pragma once

#include <span>

#include "collide/outline_lanes.hpp"
#include "collide/sphere_tree.hpp"
#include "collide/tool_frame.hpp"

namespace riffler::collide {

/// Half the side lengths (mm) of boxes along the part's axes, and the volume of material in each (mm³). Their centres
/// are those of the bounding spheres.
struct alignas(64) BoxGroup {
  double half[3][base::kLanes]{}, volume[base::kLanes]{};
};

/// How far each box lies inside the tool.
struct BoxShares {
  double distance[base::kLanes];   ///< of the box's centre, mm
  double share[base::kLanes];      ///< fraction of the volume inside the tool
  double rise[base::kLanes];       ///< derivative of the fraction as the tool approaches, 1/mm
  double normal[3][base::kLanes];  ///< of the tool's surface there, part frame
};

/// Approximates the tool at each box by its tangent plane: the half-space at the distance of the box's centre,
/// perpendicular to the direction to the nearest point of the outline. The fraction is exact except along the shortest
/// of the box's three projected widths, which two sample points represent. It is as continuous in the pose as distances
/// are, with a continuous derivative except for faces that approach flat, and the fractions of adjacent boxes add up to
/// that of their union.
void box_shares(std::span<const LaneEdge> outline, const ToolFrame& frame, const SphereGroup& spheres,
                const BoxGroup& boxes, BoxShares& out);

}  // namespace riffler::collide
