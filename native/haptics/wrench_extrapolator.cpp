#include "riffler/haptics/wrench_extrapolator.hpp"

#include <algorithm>
#include <cmath>

#include "riffler/base/check.hpp"

namespace riffler::haptics {

namespace {

/// Scaled down so that force and torque are within the bounds; their ratio stays.
Wrench within(const Wrench& w, const Bounds& bounds, double times = 1) {
  const double force = glm::length(w.force), torque = glm::length(w.torque);
  double gain = 1;
  if (force > times * bounds.linear) gain = times * bounds.linear / force;
  if (torque > times * bounds.angular) gain = std::min(gain, times * bounds.angular / torque);
  return gain == 1 ? w : gain * w;
}

}  // namespace

void WrenchExtrapolatorSettings::validate() const {
  base::require_not_negative(ahead, "ahead");
  base::require_positive(fade, "fade");
  require_not_negative(rate, "rate");
  require_not_negative(most, "most");
  if (ahead > fade) throw std::invalid_argument("ahead must be at most fade");
}

WrenchExtrapolator::WrenchExtrapolator(const WrenchExtrapolatorSettings& settings) : settings_(settings) {
  settings.validate();
}

void WrenchExtrapolator::reset() {
  out_ = last_ = slope_ = {};
  age_ = 0, begun_ = false;
}

Wrench WrenchExtrapolator::towards(const Wrench& goal, double dt) {
  const Wrench whole = goal - out_, change = within(whole, settings_.rate, dt);
  out_ = change == whole ? goal : out_ + change;
  return out_;
}

Wrench WrenchExtrapolator::stepped(const Wrench& wrench, double dt) {
  if (!finite(wrench) || !(dt > 0)) return missed(dt);
  const Wrench now = within(wrench, settings_.most);
  const double since = age_ + dt;
  slope_ = begun_ ? within(1 / since * (now - last_), settings_.rate) : Wrench{};
  last_ = now, age_ = 0, begun_ = true;
  return towards(now, dt);
}

Wrench WrenchExtrapolator::missed(double dt) {
  if (!(dt > 0) || !std::isfinite(dt)) return out_;
  age_ += dt;
  // The slope falls linearly to zero at `ahead`, the whole output linearly to zero at `fade`.
  const double t = std::min(age_, settings_.ahead);
  const double gone = settings_.ahead > 0 ? t - 0.5 * t * t / settings_.ahead : 0;
  const double gain = std::max(0.0, 1 - age_ / settings_.fade);
  return towards(gain * within(last_ + gone * slope_, settings_.most), dt);
}

}  // namespace riffler::haptics
