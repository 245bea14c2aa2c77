// Force and torque of a part's surface on a tool that is in it: (4.7), (4.8).
#pragma once

#include "collide/deadline.hpp"
#include "collide/sample_points.hpp"
#include "collide/tool_frame.hpp"
#include "riffler/collide/assembly.hpp"
#include "riffler/collide/contact.hpp"

namespace riffler::collide {

/// k of (4.7), N per mm of depth and mm² of surface. Tracing is weak, collision strong (4.4.3).
struct Stiffness {
  double cutter, holder;  // holder: the shank, too
};

/// Adds ∫ k · depth · n dA over the surface in the tool, its torque about the tip, and the points that were summed. The
/// sum is continuous in the pose: depths are, and the weights of points change with their distance from the cutter, not
/// by what they touch. Away from the cutter, where nothing is traced, nodes up to `coarse` spacings wide stand for
/// their points. After the deadline, nodes of any width do.
void add_force(const Assembly& assembly, const ToolFrame& frame, const SamplePoints& points, const Stiffness& stiffness,
               double coarse, Deadline& deadline, Contact& contact, Counts& counts);

}  // namespace riffler::collide
