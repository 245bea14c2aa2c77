// Coordinates in which a tool stands still.
#pragma once

#include "riffler/geom/pose.hpp"

namespace riffler::collide {

/// A right-handed frame with its origin in the tip and its third direction along the axis. Subtracting the tip first
/// keeps what is small near the tool small, wherever the part stands.
struct ToolFrame {
  Vec3 tip, u, v, axis;

  /// std::invalid_argument where the axis is not finite or its length differs from 1 by more than 1e-6, or the tip is
  /// not finite.
  explicit ToolFrame(const Pose& pose);

  Vec3 to_tool(const Vec3& p) const {
    const Vec3 d = p - tip;
    return {glm::dot(d, u), glm::dot(d, v), glm::dot(d, axis)};
  }
  Vec3 to_part(const Vec3& q) const { return tip + turned(q); }
  /// The same for directions.
  Vec3 turned(const Vec3& d) const { return d.x * u + d.y * v + d.z * axis; }
};

}  // namespace riffler::collide
