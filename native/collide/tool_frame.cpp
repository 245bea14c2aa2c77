#include "collide/tool_frame.hpp"

#include <stdexcept>

namespace riffler::collide {

ToolFrame::ToolFrame(const Pose& pose) : tip(pose.tip), u(0), v(0), axis(pose.axis) {
  if (!geom::finite(tip)) throw std::invalid_argument("pose: the tip is not finite");
  const double length = glm::length(axis);
  if (!(std::abs(length - 1) <= 1e-6)) throw std::invalid_argument("pose: the axis is not a unit vector");
  axis /= length;
  // Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017: robust for every direction.
  const double sign = std::copysign(1.0, axis.z), a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
  u = {1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x};
  v = {b, sign + axis.y * axis.y * a, -axis.y};
}

}  // namespace riffler::collide
