// A device behind the common interface of devices: a model, run by the driver.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include "pen/driver.hpp"
#include "riffler/haptics/safety.hpp"
#include "riffler/pen/device.hpp"

namespace riffler::pen {

/// The step of a device without a force computation in its own thread: renders the last requested wrench for 20 ms,
/// through the safety gate (haptics/safety.hpp) with its own settings. A request acts as the dead-man switch.
class HeldPush final : public PenStep {
 public:
  static constexpr double kHeld = 0.02;  // s

  explicit HeldPush(const haptics::SafetySettings& settings = {}) : safety_(settings) { safety_.switch_on(); }

  /// Requests a wrench. One thread only; `now` is on the driver's clock.
  void ask(const Wrench& wrench, double now) noexcept { asked_.set({wrench, now}); }
  /// Clears a trip with the next step. Any thread.
  void reset() noexcept { reset_.store(true); }
  haptics::SafeWrench step(const PenSample& sample, double now, double dt) noexcept override;

  /// As of the last step. Any thread.
  haptics::ForceState state() const noexcept { return state_.load(); }
  haptics::Cause cause() const noexcept { return cause_.load(); }

 private:
  struct Asked {
    Wrench wrench{};
    double time = -1e300;
  };
  Published<Asked> asked_;
  haptics::Safety safety_;  // used by the driver's thread
  std::atomic<haptics::ForceState> state_{haptics::ForceState::Off};
  std::atomic<haptics::Cause> cause_{haptics::Cause::None};
  std::atomic<bool> reset_{false};
};

/// A step of the driver's thread that another thread may replace at any time. The driver never waits for that: a tick
/// during a replacement pushes nothing.
class StepSwitch final : public PenStep {
 public:
  /// `step` must not be null.
  explicit StepSwitch(std::shared_ptr<PenStep> step) : step_(std::move(step)) {}

  /// Replaces the step; not null. The previous step is no longer called afterwards, and is released by the calling
  /// thread.
  void set(std::shared_ptr<PenStep> step);
  haptics::SafeWrench step(const PenSample& sample, double now, double dt) noexcept override;

 private:
  std::mutex mutex_;  // held while a step is called; the driver only tries to lock it
  std::shared_ptr<PenStep> step_;
  bool begins_ = true;  // the step has not been called yet
  double missed_ = 0;   // s: ticks missed since its last call; used by the driver's thread
};

class DrivenPen : public Pen {
 public:
  /// `transport`: open and checked; `open` finds, opens and checks the device again. `clock`: as in
  /// Driver; a subclass that passes one overrides now().
  DrivenPen(std::string kind, std::shared_ptr<PenModel> model, std::unique_ptr<Transport> transport, Driver::Open open,
            const DriverSettings& settings = {}, std::shared_ptr<Clock> clock = nullptr);

  std::string kind() const override { return kind_; }
  const DeviceCapability& capability() const noexcept override { return model_->capability(); }
  haptics::PassivitySettings passivity() const override { return model_->passivity(); }
  std::string about() const override { return model_->about(); }
  const PenGeometry* geometry() const noexcept override { return model_->geometry(); }
  PenSample newest() const noexcept override { return status().sample; }
  double now() const noexcept override { return steady_seconds(); }
  PushAnswer push(const Wrench& wrench) noexcept override;
  bool set_step(std::shared_ptr<PenStep> step) override;
  bool home() noexcept override { return model_->home(); }
  /// These three refer to push(), whose trips outlast other steps.
  void reset() noexcept override { held_->reset(); }
  haptics::ForceState force_state() const noexcept override {
    return pushes_ ? held_->state() : haptics::ForceState::Off;
  }
  haptics::Cause cause() const noexcept override { return pushes_ ? held_->cause() : haptics::Cause::None; }
  LinkStatus status() const noexcept override { return driver_.status(); }
  std::string problem() const override { return driver_.problem(); }
  base::ThreadPriority priority() const override { return driver_.priority(); }
  bool stop() override { return driver_.stop(); }

 private:
  std::string kind_;
  std::shared_ptr<PenModel> model_;
  std::shared_ptr<HeldPush> held_;
  std::shared_ptr<StepSwitch> switch_;
  std::atomic<bool> pushes_{true};  // the active step is held_
  Driver driver_;                   // last, because its threads use the other members
};

}  // namespace riffler::pen
