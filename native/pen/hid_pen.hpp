// A HID device behind the interface of all devices: its model, driven by the driver.
#pragma once

#include <atomic>
#include <memory>
#include <string>

#include "haptics/safety.hpp"
#include "pen/device.hpp"
#include "pen/driver.hpp"

namespace riffler {

/// The step of a device that nobody computes a force for in its own thread: what was last asked for, for 20 ms, through
/// the gate of all forces (haptics/safety.hpp) with its own settings. Asking is the dead man's switch.
class HeldPush final : public PenStep {
 public:
  static constexpr double kHeld = 0.02;  // s

  explicit HeldPush(const SafetySettings& settings = {}) : safety_(settings) { safety_.switch_on(); }

  /// By one thread; `now` of the driver's clock.
  void ask(const Wrench& wrench, double now) noexcept { asked_.set({wrench, now}); }
  /// Clears a trip with the next step. Any thread.
  void reset() noexcept { reset_.store(true); }
  SafeWrench step(const PenSample& sample, double now, double dt) noexcept override;

  /// As of the last step. Any thread.
  ForceState state() const noexcept { return state_.load(); }
  Cause cause() const noexcept { return cause_.load(); }

 private:
  struct Asked {
    Wrench wrench{};
    double time = -1e300;
  };
  Published<Asked> asked_;
  Safety safety_;  // the driver's thread's
  std::atomic<ForceState> state_{ForceState::Off};
  std::atomic<Cause> cause_{Cause::None};
  std::atomic<bool> reset_{false};
};

class HidPen : public Pen {
 public:
  /// `transport` is open and checked by the model; `open` finds, opens and checks it again. `step` computes the wrench
  /// in the driver's thread; without one, push() says it.
  HidPen(std::string kind, std::shared_ptr<HidModel> model, std::unique_ptr<Transport> transport, Driver::Open open,
         std::shared_ptr<PenStep> step = nullptr, const DriverSettings& settings = {});

  std::string kind() const override { return kind_; }
  const DeviceCapability& capability() const noexcept override { return model_->capability(); }
  std::string about() const override { return model_->about(); }
  PenSample newest() const noexcept override { return status().sample; }
  double now() const noexcept override { return steady_seconds(); }
  /// With a step of its own the device takes nothing from here: all of it is missing.
  PushAnswer push(const Wrench& wrench) noexcept override;
  bool home() noexcept override { return model_->home(); }
  void reset() noexcept override {
    if (held_) held_->reset();
  }
  ForceState force_state() const noexcept override { return held_ ? held_->state() : ForceState::Off; }
  Cause cause() const noexcept override { return held_ ? held_->cause() : Cause::None; }
  LinkStatus status() const noexcept override { return driver_.status(); }
  std::string problem() const override { return driver_.problem(); }
  bool stop() override { return driver_.stop(); }

 private:
  std::string kind_;
  std::shared_ptr<HidModel> model_;
  std::shared_ptr<HeldPush> held_;  // null with another step
  Driver driver_;
};

}  // namespace riffler
