#include "riffler/haptics/safety.hpp"

#include <algorithm>
#include <cmath>

#include "geom/directions.hpp"
#include "riffler/base/check.hpp"

namespace riffler::haptics {

void SafetySettings::validate() const {
  base::require_positive(ramp, "ramp");
  base::require_positive(fall, "fall");
  base::require_positive(fresh, "fresh");
  base::require_positive(fade, "fade");
  base::require_not_negative(rest, "rest");
  require_positive(overspeed, "overspeed");
  require_positive(jump, "jump");
  base::require_positive(redundancy, "redundancy");
  require_positive(wrench_ceiling, "wrench_ceiling");
}

Safety::Safety(const SafetySettings& settings) : settings_(settings) {
  settings.validate();
}

double Safety::freshness(const Observation& now) const {
  return std::clamp(1 - (std::max(now.age, now.dt) - settings_.fresh) / settings_.fade, 0.0, 1.0);
}

/// The first check that fails, in the order of Cause.
Safety::Finding Safety::check(const Observation& now) const {
  if (!(now.dt >= 0) || std::isinf(now.dt)) return {Cause::BadTime, now.dt};
  if (!geom::finite(now.pose.tip) || !geom::finite(now.pose.axis) || !finite(now.twist) ||
      !std::isfinite(now.redundancy) || !std::isfinite(now.age))
    return {Cause::NotFinite, 0};
  if (now.device_fault)
    return {now.device_late ? Cause::DeviceLate : Cause::DeviceFault, static_cast<double>(now.device_fault)};
  // Before homing, a device has no pose to check.
  if (state_ == ForceState::Homing && !now.homed) return {Cause::None, 0};
  if (!now.homed) return {Cause::NotHomed, 0};
  if (std::abs(now.redundancy) > settings_.redundancy) return {Cause::Redundancy, now.redundancy};
  if (const Finding motion = check_motion(now); motion.cause != Cause::None) return motion;
  if (freshness(now) > 0) return {Cause::None, 0};
  return now.dt >= now.age ? Finding{Cause::LateTick, now.dt} : Finding{Cause::Stale, now.age};
}

Safety::Finding Safety::check_motion(const Observation& now) const {
  if (placed_) {
    // After a late tick the hand may have moved further, but not faster than the next check allows.
    const double way = glm::length(now.pose.tip - last_.tip), turn = geom::angle_between(now.pose.axis, last_.axis);
    if (way > settings_.jump.linear + settings_.overspeed.linear * now.dt) return {Cause::Jump, way};
    if (turn > settings_.jump.angular + settings_.overspeed.angular * now.dt) return {Cause::Jump, turn};
  }
  const double speed = glm::length(now.twist.linear), spin = glm::length(now.twist.angular);
  const double share = speed / settings_.overspeed.linear, spin_share = spin / settings_.overspeed.angular;
  if (!(std::max(share, spin_share) < 1)) return {Cause::Overspeed, share >= spin_share ? speed : spin};
  return {Cause::None, 0};
}

ForceState Safety::observe(const Observation& now) {
  permitted_ = false;
  const bool forward = now.dt > 0 && std::isfinite(now.dt);
  if (forward) time_ += now.dt;
  if (state_ == ForceState::Off) {
    placed_ = false;
    return state_;
  }
  const Finding finding = check(now);
  if (geom::finite(now.pose.tip) && geom::finite(now.pose.axis)) last_ = now.pose, placed_ = now.homed;
  if (finding.cause != Cause::None) {
    trip(finding);
    return state_;
  }
  if (now.homed) apply(ForceEvent::Homed);
  rest(now.dt);
  let_go(now);
  if (lets_force_through(state_)) {
    move_gain(now.dt, freshness(now));
    permitted_ = true;
  } else if (state_ == ForceState::Ready) {
    fall(now.dt, freshness(now));
  }
  return state_;
}

/// Records a finding and takes the force away. While tripped, a finding only restarts the rest period, unless it is
/// more severe.
void Safety::trip(const Finding& finding) {
  rested_ = 0;
  const bool news = state_ != ForceState::Tripped || (heals(cause_) && !heals(finding.cause));
  if (!news) return;
  log_.add({time_, state_, finding.cause, finding.value});
  cause_ = finding.cause;
  apply(ForceEvent::Trip);
}

void Safety::rest(double dt) {
  if (state_ != ForceState::Tripped) return;
  rested_ += dt;
  if (heals(cause_) && rested_ >= settings_.rest) apply(ForceEvent::Rested);
}

/// The dead-man switch. Releasing it is not a fault, so no rest is required: pressing it again begins the ramp.
void Safety::let_go(const Observation& now) {
  if (!now.dead_man && lets_force_through(state_)) {
    log_.add({time_, state_, Cause::NoDeadMan, 0});
    cause_ = Cause::NoDeadMan;
    falling_ = gain_;
  }
  if (now.dead_man && falling()) return;
  apply(now.dead_man ? ForceEvent::Press : ForceEvent::Release);
}

void Safety::interrupt() {
  placed_ = false;
  apply(ForceEvent::Release);
  falling_ = 0;
}

/// Raises the gain along the ramp; lowers it at once to the freshness.
void Safety::move_gain(double dt, double freshness) {
  cause_ = Cause::None;
  // A late tick must not raise the gain faster.
  gain_ = std::min({1.0, gain_ + std::min(dt, settings_.fresh) / settings_.ramp, freshness});
  if (freshness < 1) apply(ForceEvent::Late);
  if (gain_ >= 1) apply(ForceEvent::Risen);
}

/// Lowers the gain of a force after the dead-man switch; a late tick lowers it further.
void Safety::fall(double dt, double freshness) {
  falling_ = std::clamp(falling_ - dt / settings_.fall, 0.0, freshness);
  gain_ = falling_;
  permitted_ = falling();
}

void Safety::apply(ForceEvent event) {
  state_ = next(state_, event);
  if (!lets_force_through(state_)) gain_ = 0, permitted_ = false;
  if (state_ == ForceState::Off || state_ == ForceState::Homing || state_ == ForceState::Tripped) falling_ = 0;
  if (state_ == ForceState::Off) cause_ = Cause::None;
}

SafeWrench Safety::release(const Wrench& wanted) {
  const bool permitted = permitted_;
  permitted_ = false;
  if (!permitted) return {};
  if (!finite(wanted)) {
    trip({Cause::BadWrench, 0});
    return {};
  }
  const double force = glm::length(wanted.force), torque = glm::length(wanted.torque);
  if (!(force <= settings_.wrench_ceiling.linear) || !(torque <= settings_.wrench_ceiling.angular)) {
    trip({Cause::Excess, force > settings_.wrench_ceiling.linear ? force : torque});
    return {};
  }
  return SafeWrench(gain_ * wanted, gain_);
}

}  // namespace riffler::haptics
