#include "riffler/pen/pointer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::pen {

void PointerFrame::validate() const {
  const auto fail = [](const char* what) { throw std::invalid_argument(std::string("frame of the pointer: ") + what); };
  constexpr double kSlack = 1e-6;
  if (!geom::finite(origin)) fail("origin must be finite");
  if (!(std::abs(glm::length(right) - 1) < kSlack)) fail("right must be of unit length");
  if (!(std::abs(glm::length(up) - 1) < kSlack)) fail("up must be of unit length");
  if (!(std::abs(glm::dot(right, up)) < kSlack)) fail("right and up must be perpendicular to each other");
  if (!(scale > 0 && std::isfinite(scale))) fail("scale must be positive");
  if (!(depth >= 0 && std::isfinite(depth))) fail("depth must not be negative");
  if (!(max_tilt >= 0 && max_tilt < kPi / 2)) fail("max_tilt must be at least 0 and less than pi/2");
}

Vec3 tilted_axis(const PointerFrame& frame, double tilt_x, double tilt_y) noexcept {
  const Vec3 upright = glm::cross(frame.right, frame.up);
  // Each tilt is the angle of the pen's projection on one plane: tangents add up.
  const auto slope = [&](double tilt) {
    return std::isfinite(tilt) ? base::tan(std::clamp(tilt, -frame.max_tilt, frame.max_tilt)) : 0.0;
  };
  Vec2 lean(slope(tilt_x), slope(tilt_y));
  const double most = base::tan(frame.max_tilt), length = glm::length(lean);
  if (length > most) lean *= most / length;
  return glm::normalize(upright + lean.x * frame.right + lean.y * frame.up);
}

PointerPen::PointerPen(Kind kind, const PointerFrame& frame) : kind_(kind) {
  set_frame(frame);
  capability_.name = kind == Kind::Tablet ? "tablet" : "mouse";
  const std::size_t sensed = kind == Kind::Tablet ? 5 : 2;
  for (std::size_t k = 0; k < sensed; ++k) capability_.coordinates[k].sensing = Sensing::Position;
  capability_.turns = TurnAxes::Grip;
}

void PointerPen::set_frame(const PointerFrame& frame) {
  frame.validate();
  frame_ = frame;
}

bool PointerPen::give(const PointerEvent& event) noexcept {
  const bool first = last_.sequence == 0;
  const double dt = event.time - last_.time;
  const bool good = std::isfinite(event.x) && std::isfinite(event.y) && std::isfinite(event.pressure) &&
                    std::isfinite(event.time) && (first || dt >= 0);
  if (!good) return false;
  const Vec3 upright = glm::cross(frame_.right, frame_.up);
  Pose pose;
  pose.tip = frame_.origin + frame_.scale * (event.x * frame_.right + event.y * frame_.up) -
             frame_.depth * std::clamp(event.pressure, 0.0, 1.0) * upright;
  pose.axis = kind_ == Kind::Tablet ? tilted_axis(frame_, event.tilt_x, event.tilt_y) : upright;
  if (!geom::finite(pose.tip)) return false;
  last_.velocity = first || dt == 0 ? Vec3(0) : (pose.tip - last_.pose.tip) / dt;
  last_.pose = pose;
  last_.time = event.time;
  last_.buttons = event.buttons;
  last_.homed = true;
  ++last_.sequence;
  newest_.set(last_);
  return true;
}

}  // namespace riffler::pen
