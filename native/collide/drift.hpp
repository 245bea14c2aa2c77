// How far points of a part move past a tool in a stretch of its motion.
#pragma once

#include <algorithm>
#include <cmath>

#include "collide/tool_frame.hpp"

namespace riffler::collide {

/// Points of the part in a frame that moves with the tool, within half a stretch of a motion from its middle. There a
/// point q from the tip goes the way ± (way + turn × q) but for second_order(q).
struct Drift {
  Vec3 way{0}, turn{0};  ///< of the tool in half the stretch, mm and rad
  double reach = 0;      ///< of the tool from its tip, mm

  Drift() = default;
  Drift(const Motion& motion, double duration, double r)
      : way(0.5 * duration * (motion.to().tip - motion.from().tip)),
        turn(0.5 * duration * motion.rotation()),
        reach(r) {}

  /// From the part's directions to the tool's.
  Drift in(const ToolFrame& f) const {
    Drift out;
    out.way = {glm::dot(way, f.u), glm::dot(way, f.v), glm::dot(way, f.axis)};
    out.turn = {glm::dot(turn, f.u), glm::dot(turn, f.v), glm::dot(turn, f.axis)};
    out.reach = reach;
    return out;
  }

  /// The second derivative of a point that is fixed while a frame turns at a constant rate ω and goes at a constant
  /// speed v is at most ω² |q| + 2 ω v.
  double second_order(double distance) const {
    const double w = glm::length(way), a = glm::length(turn);
    return 0.5 * a * (a * (distance + w) + 2 * w);
  }
  /// No point at a distance from the tip goes further.
  double most(double distance) const {
    const double w = glm::length(way);
    return w + glm::length(turn) * (distance + w);
  }
  /// Nor does the tool come nearer to one by more than this: its own points go less far than those beyond it.
  double nearer(double distance) const {
    const double w = glm::length(way);
    return w + glm::length(turn) * std::min(distance + w, reach);
  }
  /// No point goes further than this along a unit direction.
  double along(const Vec3& direction, const Vec3& q) const {
    return std::abs(glm::dot(direction, way + glm::cross(turn, q))) + second_order(glm::length(q));
  }
};

}  // namespace riffler::collide
