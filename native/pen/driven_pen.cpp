#include "pen/driven_pen.hpp"

#include <utility>

#include "pen/observation.hpp"

namespace riffler::pen {

namespace {

/// Zeroes rounding noise: projecting on the motors' axes and back leaves about 1e-16 of the request.
Vec3 beyond_rounding(const Vec3& missing, const Vec3& asked) {
  constexpr double kRounding = 1e-12;
  return glm::length(missing) <= kRounding * glm::length(asked) ? Vec3(0) : missing;
}

}  // namespace

haptics::SafeWrench HeldPush::step(const PenSample& sample, double now, double dt) noexcept {
  const Asked asked = asked_.get();
  const bool fresh = now - asked.time <= kHeld;
  if (dt == 0) safety_.interrupt();
  if (reset_.exchange(false)) safety_.reset();
  safety_.observe(observation_of(sample, now, dt, fresh));
  // A wrench that no program renews ends at once; Safety's fall is for a hand that lets go.
  const haptics::SafeWrench safe = fresh ? safety_.release(asked.wrench) : haptics::SafeWrench{};
  state_.store(safety_.state());
  cause_.store(safety_.cause());
  return safe;
}

void StepSwitch::set(std::shared_ptr<PenStep> step) {
  const std::lock_guard lock(mutex_);
  step_.swap(step);  // its destructor may be slow, so it runs after the lock is released
  begins_ = true;
}

haptics::SafeWrench StepSwitch::step(const PenSample& sample, double now, double dt) noexcept {
  const double since = dt > 0 ? missed_ + dt : dt;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  missed_ = lock ? 0 : since;
  if (!lock) return {};
  return step_->step(sample, now, std::exchange(begins_, false) ? 0 : since);
}

DrivenPen::DrivenPen(std::string kind, std::shared_ptr<PenModel> model, std::unique_ptr<Transport> transport,
                     Driver::Open open, const DriverSettings& settings, std::shared_ptr<Clock> clock)
    : kind_(std::move(kind)),
      model_(std::move(model)),
      held_(std::make_shared<HeldPush>()),
      switch_(std::make_shared<StepSwitch>(held_)),
      driver_(model_, switch_, std::move(transport), std::move(open), settings, std::move(clock)) {}

bool DrivenPen::set_step(std::shared_ptr<PenStep> step) {
  pushes_ = step == nullptr;
  switch_->set(step ? std::move(step) : held_);
  return true;
}

PushAnswer DrivenPen::push(const Wrench& wrench) noexcept {
  if (!finite(wrench)) {
    if (pushes_) held_->ask({}, now());
    return {{}, {}, NotPushed::BadWrench};
  }
  if (!pushes_ || !capability().has_force()) return Pen::push(wrench);
  const LinkStatus link = status();
  const auto refused = [&](NotPushed reason) { return PushAnswer{{}, wrench, reason}; };
  held_->ask(wrench, now());
  if (link.state != LinkState::Connected) return refused(NotPushed::NotConnected);
  if (!link.sample.powered) return refused(NotPushed::NotPowered);
  if (!link.sample.homed) return refused(NotPushed::NotHomed);
  if (held_->state() == haptics::ForceState::Tripped) return refused(NotPushed::Tripped);
  const Wrench felt = renderable(pushed(capability(), link.sample.pose.axis), wrench);
  const Wrench missing{beyond_rounding(wrench.force - felt.force, wrench.force),
                       beyond_rounding(wrench.torque - felt.torque, wrench.torque)};
  return {wrench - missing, missing, missing == Wrench{} ? NotPushed::None : NotPushed::NoMotors};
}

}  // namespace riffler::pen
