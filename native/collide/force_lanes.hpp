// The force of several sample points at a time, in vector lanes chosen at run time.
#pragma once

#include <algorithm>
#include <span>

#include "collide/outline_lanes.hpp"
#include "collide/sample_points.hpp"
#include "collide/tool_frame.hpp"
#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// k of (4.7), N per mm of depth and mm² of surface: weak for tracing with the cutter, strong for collisions (4.4.3).
struct Stiffness {
  double cutter, holder;  // holder: also for the shank
};

/// Sums of force (N), torque about the tip (N·mm) and stiffness, in part directions, lane by lane: their order, and so
/// their rounding, is the same for every instruction set.
struct ForceSums {
  static constexpr int kTriangle = 21;  // of the symmetric 6 × 6 matrix: the columns of each row up to the diagonal
  double force[3][base::kLanes]{}, torque[3][base::kLanes]{}, stiffness[kTriangle][base::kLanes]{};

  void add_to(Contact& contact) const;
};

/// k of (4.7) by height: that of the cutter, that of the holder above it, and a ramp as long as the point spacing, so
/// that the force has no step at the end of the cutter.
struct StiffnessRamp {
  Stiffness stiffness;
  double top, length;  ///< mm: end of the cutter, length of the ramp

  double at(double z) const {
    const double above = std::min(std::max((z - top) / length + 0.5, 0.0), 1.0);
    return stiffness.cutter + above * (stiffness.holder - stiffness.cutter);
  }
};

/// Up to eight points, and which of them lie inside the tool.
struct PointGroup {
  const SphereGroup* points;
  const SamplePoints::AreaGroup* areas;
  double weight;                ///< of each point
  unsigned inside;              ///< a bit for each point
  double z[base::kLanes];       ///< mm above the tip
  double square[base::kLanes];  ///< mm²: of the depth
};

/// Adds the points of the groups that lie inside the tool, and fills the groups' results.
void add_points(std::span<const LaneEdge> outline, const ToolFrame& frame, std::span<PointGroup> groups,
                const StiffnessRamp& ramp, ForceSums& sums);

}  // namespace riffler::collide
