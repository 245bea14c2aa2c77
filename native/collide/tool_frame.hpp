// The tool's own coordinate frame.
#pragma once

#include "riffler/geom/pose.hpp"

namespace riffler::collide {

/// A right-handed frame with its origin at the tip and its third axis along the tool's axis. Subtracting the tip first
/// keeps precision near the tool, wherever the part lies.
struct ToolFrame {
  Vec3 tip, u, v, axis;

  /// Throws std::invalid_argument if the axis is not finite or its length differs from 1 by more than 1e-6, or if the
  /// tip is not finite.
  explicit ToolFrame(const Pose& pose);

  Vec3 to_tool(const Vec3& p) const { return seen(p - tip); }
  /// Rotates a direction from the part's frame to the tool's.
  Vec3 seen(const Vec3& d) const { return {glm::dot(d, u), glm::dot(d, v), glm::dot(d, axis)}; }
  Vec3 to_part(const Vec3& q) const { return tip + turned(q); }
  /// Rotates a direction from the tool's frame to the part's.
  Vec3 turned(const Vec3& d) const { return d.x * u + d.y * v + d.z * axis; }
};

}  // namespace riffler::collide
