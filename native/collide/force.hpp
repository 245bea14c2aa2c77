// Force and torque of a part's surface on a tool that intersects it: (4.7), (4.8).
#pragma once

#include "collide/deadline.hpp"
#include "collide/force_lanes.hpp"
#include "collide/sample_points.hpp"
#include "collide/tool_frame.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// Adds ∫ k · depth · n dA over the surface inside the tool, the torque about the tip, and the points summed. The sum
/// is continuous in the pose: depths are, and the weights of points depend on their distance from the cutter, not on
/// contact. Away from the cutter, nodes up to `coarse` spacings wide represent their points; with `merge`, so do nodes
/// that are small for the cutter, a hundredth of its diameter. After the deadline, nodes of any width do.
void add_force(const Assembly& assembly, const ToolFrame& frame, const SamplePoints& points, const Stiffness& stiffness,
               double coarse, bool merge, Deadline& deadline, Contact& contact, Counts& counts);

}  // namespace riffler::collide
