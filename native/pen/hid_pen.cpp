#include "pen/hid_pen.hpp"

#include <utility>

namespace riffler {

Wrench HeldPush::step(const PenSample&, double now, double) noexcept {
  const Asked asked = asked_.get();
  return now - asked.time <= kHeld ? asked.wrench : Wrench{};
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
  const Wrench felt = renderable(pushed(capability(), link.sample.pose.axis), wrench), missing = wrench - felt;
  return {felt, missing, missing == Wrench{} ? NotPushed::None : NotPushed::NoMotors};
}

}  // namespace riffler
