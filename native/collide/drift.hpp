// Bound on how far points of a part move relative to the tool during an interval of its motion.
#pragma once

#include <algorithm>
#include <cmath>

#include "collide/tool_frame.hpp"

namespace riffler::collide {

/// Motion of the part's points in the tool's frame, during half an interval on either side of its middle. A point q
/// from the tip moves by ± (translation + rotation × q), up to an error of second_order(|q|).
struct Drift {
  Vec3 way{0}, turn{0};  ///< of the tool in half the interval, mm and rad
  double reach = 0;      ///< largest distance of the tool's points from its tip, mm

  Drift() = default;
  Drift(const Motion& motion, double duration, double r)
      : way(0.5 * duration * (motion.to().tip - motion.from().tip)),
        turn(0.5 * duration * motion.rotation()),
        reach(r) {}

  /// The same drift, from part directions to tool directions.
  Drift in(const ToolFrame& f) const {
    Drift out;
    out.way = f.seen(way), out.turn = f.seen(turn);
    out.reach = reach;
    return out;
  }

  /// Bound on the second-order term: the second derivative of a fixed point, seen from a frame that turns at a constant
  /// rate ω and moves at a constant speed v, is at most ω² |q| + 2 ω v.
  double second_order(double distance) const {
    const double w = glm::length(way), a = glm::length(turn);
    return 0.5 * a * (a * (distance + w) + 2 * w);
  }
  /// Largest displacement of any point at `distance` (mm) from the tip.
  double most(double distance) const {
    const double w = glm::length(way);
    return w + glm::length(turn) * (distance + w);
  }
  /// Largest decrease of the tool's distance to such a point. Points of the tool move less than points beyond its
  /// reach.
  double nearer(double distance) const {
    const double w = glm::length(way);
    return w + glm::length(turn) * std::min(distance + w, reach);
  }
  /// Largest displacement of point `q` along a unit direction.
  double along(const Vec3& direction, const Vec3& q) const {
    return std::abs(glm::dot(direction, way + glm::cross(turn, q))) + second_order(glm::length(q));
  }
};

}  // namespace riffler::collide
