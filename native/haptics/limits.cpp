#include "riffler/haptics/limits.hpp"

#include <algorithm>
#include <cmath>

#include "riffler/base/check.hpp"

namespace riffler::haptics {

namespace {

/// Largest factor ≤ 1 with factor · value ≤ limit.
double factor(double value, double limit) {
  return value <= limit ? 1 : limit / value;
}

double ramp_down(double speed, double full, double none) {
  if (speed <= full) return 1;
  return speed < none ? (none - speed) / (none - full) : 0;  // 0 for NaN
}

}  // namespace

void LimitSettings::validate() const {
  require_not_negative(wrench, "wrench");
  require_not_negative(rate, "rate");
  base::require_not_negative(power, "power");
  require_not_negative(full_speed, "full_speed");
  require_positive(no_force_at, "no_force_at");
  if (no_force_at.linear <= full_speed.linear)
    throw std::invalid_argument("no_force_at.linear must be above full_speed.linear");
  if (no_force_at.angular <= full_speed.angular)
    throw std::invalid_argument("no_force_at.angular must be above full_speed.angular");
}

double speed_gain(const LimitSettings& s, const Twist& grip) {
  return std::min(ramp_down(glm::length(grip.linear), s.full_speed.linear, s.no_force_at.linear),
                  ramp_down(glm::length(grip.angular), s.full_speed.angular, s.no_force_at.angular));
}

double magnitude_gain(const LimitSettings& s, const Wrench& w) {
  return std::min(factor(glm::length(w.force), s.wrench.linear), factor(glm::length(w.torque), s.wrench.angular));
}

Wrench slewed(const LimitSettings& s, const Wrench& previous, const Wrench& wanted, double dt) {
  const Wrench change = wanted - previous;
  const double time = dt > 0 ? dt : 0;
  const double share = std::min(factor(glm::length(change.force), s.rate.linear * time),
                                factor(glm::length(change.torque), s.rate.angular * time));
  return share == 1 ? wanted : previous + share * change;
}

double power_gain(const LimitSettings& s, const Wrench& w, const Twist& grip) {
  return factor(power(w, grip), s.power);
}

Wrench limited(const LimitSettings& s, const Capability& device, const Wrench& previous, const Wrench& wanted,
               const Twist& grip, double dt, LimitReport* report) {
  LimitReport r;
  Wrench w = renderable(device, wanted);
  r.unrendered = wanted - w;
  r.speed = speed_gain(s, grip);
  r.magnitude = magnitude_gain(s, w);
  w = r.speed * r.magnitude * w;
  const Wrench target = w;
  // The limits are convex, so every wrench between two that satisfy them satisfies them. But since the previous wrench
  // the pose has changed, and with it the capability and the speed: apply both again.
  w = renderable(device, slewed(s, previous, target, dt));
  r.slewed = !(w == target);
  LimitSettings slow = s;
  slow.wrench = {r.speed * s.wrench.linear, r.speed * s.wrench.angular};
  w = magnitude_gain(slow, w) * w;
  r.power = power_gain(s, w, grip);
  if (report) *report = r;
  return r.power * w;
}

}  // namespace riffler::haptics
