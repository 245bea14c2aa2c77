// Path of a tool out of the material: along its axis, then up.
#pragma once

#include <vector>

#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::nc {

/// The cylinder about the axis that contains a tool; empty for an unknown tool.
struct ToolEnvelope {
  double length = 0, radius = 0;  ///< mm

  explicit ToolEnvelope(const Tool* tool);

  /// How far (mm) the tool extends below its tip if its axis has this z component; 0 for steep axes.
  double below_tip(double axis_z) const;

  /// Box of what the cylinder sweeps between two poses (geom/pose.hpp); conservative.
  Box3 swept_box(const Pose& from, const Pose& to) const;
};

struct ClearanceZone {
  Box3 box;    ///< all tips and occupied space, grown by the clearance
  double top;  ///< z (mm) of the tip in rapids between cuts
};

/// Poses from `pose` to safe height with a constant axis: first along the axis out of the occupied space, last the
/// point at safe height.
std::vector<Pose> retract_path(const Pose& pose, const ToolEnvelope& reach, const ClearanceZone& space);

}  // namespace riffler::nc
