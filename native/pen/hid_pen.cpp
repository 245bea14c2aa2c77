#include "pen/hid_pen.hpp"

#include <utility>

namespace riffler {

SafeWrench HeldPush::step(const PenSample& sample, double now, double dt) noexcept {
  const Asked asked = asked_.get();
  const bool fresh = now - asked.time <= kHeld;
  if (reset_.exchange(false)) safety_.reset();
  safety_.observe({.dt = dt,
                   .age = now - sample.time,
                   .pose = sample.pose,
                   .twist = {sample.velocity, sample.turning},
                   .redundancy = sample.stretch,
                   .homed = sample.homed,
                   .dead_man = fresh,
                   .device_fault = sample.fault});
  const SafeWrench safe = safety_.release(fresh ? asked.wrench : Wrench{});
  state_.store(safety_.state());
  cause_.store(safety_.cause());
  return safe;
}

HidPen::HidPen(std::string kind, std::shared_ptr<HidModel> model, std::unique_ptr<Transport> transport,
               Driver::Open open, std::shared_ptr<PenStep> step, const DriverSettings& settings)
    : kind_(std::move(kind)),
      model_(std::move(model)),
      held_(step ? nullptr : std::make_shared<HeldPush>()),
      driver_(model_, step ? std::move(step) : held_, std::move(transport), std::move(open), settings) {}

PushAnswer HidPen::push(const Wrench& wrench) noexcept {
  if (!finite(wrench)) {
    if (held_) held_->ask({}, now());
    return {{}, {}, NotPushed::BadWrench};
  }
  if (!held_ || !capability().has_force()) return Pen::push(wrench);
  const LinkStatus link = status();
  const auto refused = [&](NotPushed reason) { return PushAnswer{{}, wrench, reason}; };
  held_->ask(wrench, now());
  if (link.state != LinkState::Connected) return refused(NotPushed::NotConnected);
  if (!link.sample.powered) return refused(NotPushed::NotPowered);
  if (!link.sample.homed) return refused(NotPushed::NotHomed);
  if (held_->state() == ForceState::Tripped) return refused(NotPushed::Tripped);
  const Wrench felt = renderable(pushed(capability(), link.sample.pose.axis), wrench), missing = wrench - felt;
  return {felt, missing, missing == Wrench{} ? NotPushed::None : NotPushed::NoMotors};
}

}  // namespace riffler
