// How a tool leaves the material: along its axis, then up.
#pragma once

#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::nc {

/// The cylinder about the axis that holds a tool; nothing is known of an unknown tool.
struct ToolEnvelope {
  double length = 0, radius = 0;  ///< mm

  explicit ToolEnvelope(const Tool* tool);

  /// How far the tool hangs below its tip where its axis is that high, mm; of steep ones nothing.
  double below_tip(double axis_z) const;

  /// Box of what the cylinder sweeps from one pose to another (geom/pose.hpp); never too small.
  Box3 swept_box(const Pose& from, const Pose& to) const;
};

struct ClearanceZone {
  Box3 box;    ///< all tips and what is occupied, grown by the clearance
  double top;  ///< z of the tip in rapids from cut to cut
};

/// Where the tip goes from `pose` to safe height with the axis kept: first along the axis out of the space, last the
/// point at safe height.
std::vector<Pose> retract_path(const Pose& pose, const ToolEnvelope& reach, const ClearanceZone& space);

}  // namespace riffler::nc
