// The whole stack on a virtual clock: firmware, cable, codec, model, driver's loop, gate, step.
#pragma once

#include <cmath>
#include <functional>
#include <memory>

#include "pen/driver_loop.hpp"
#include "pen/models/riffler_model.hpp"
#include "pen/observation.hpp"
#include "pen/simulated/simulated_transport.hpp"
#include "riffler/haptics/safety.hpp"

namespace riffler::test {

/// A law of force behind the gate of all forces, as a session has it.
class GatedStep final : public pen::PenStep {
 public:
  using Law = std::function<Wrench(const pen::PenSample&, double now, double dt)>;

  explicit GatedStep(const haptics::SafetySettings& settings = {}) : safety(settings) { safety.switch_on(); }
  haptics::SafeWrench step(const pen::PenSample& sample, double now, double dt) noexcept override {
    ++steps, last = sample;
    safety.observe(pen::observation_of(sample, now, dt, holds));
    const haptics::SafeWrench safe = safety.release(law(sample, now, dt));
    // A tick that finds a fault pushes with nothing.
    if (safety.state() == haptics::ForceState::Tripped && !(safe.wrench() == Wrench{})) ++pushed_while_tripped;
    after(safe.wrench());
    return safe;
  }

  Law law = [](const pen::PenSample&, double, double) { return Wrench{}; };
  std::function<void(const Wrench&)> after = [](const Wrench&) {};
  haptics::Safety safety;
  bool holds = true;  // the dead-man switch
  pen::PenSample last{};
  int steps = 0, pushed_while_tripped = 0;
};

class SimulatedConnector final : public pen::Connector {
 public:
  SimulatedConnector(std::shared_ptr<pen::SimulatedPen> pen, std::shared_ptr<pen::SimulatedClock> clock,
                     pen::HidModel& model)
      : pen_(std::move(pen)), clock_(std::move(clock)), model_(model) {}
  void begin() noexcept override {}
  Answer poll(std::unique_ptr<pen::Transport>& transport, pen::OpenProblem& problem) noexcept override {
    auto found = std::make_unique<pen::SimulatedTransport>(pen_, clock_);
    try {
      model_.check(*found);
    } catch (const pen::OpenError& error) {
      problem = error.problem();
      return Answer::Failed;
    }
    transport = std::move(found);
    return Answer::Opened;
  }

 private:
  std::shared_ptr<pen::SimulatedPen> pen_;
  std::shared_ptr<pen::SimulatedClock> clock_;
  pen::HidModel& model_;
};

/// Homed, the gate open, nothing pushed with yet.
struct SimulatedBench {
  explicit SimulatedBench(const pen::SimulatedPenSettings& settings = {}, pen::HandPath path = nullptr,
                          const haptics::SafetySettings& safety = {}, const pen::Compensation& compensation = {})
      : pen(std::make_shared<pen::SimulatedPen>(settings, std::move(path))),
        step(safety),
        model(*transport, compensation) {
    home = pen->arms().posture().pose;
    model.home();
  }

  void tick() {
    loop.tick();
    catch_up();
  }
  void run(double seconds) {
    const double end = clock->now() + seconds;
    while (clock->now() < end) tick();
  }
  /// The host is dead.
  void run_alone(double seconds) {
    clock->wait(seconds);
    catch_up();
  }
  void catch_up() { pen->advance(std::llround(1e6 * clock->now())); }
  double now() const { return clock->now(); }

  std::shared_ptr<pen::SimulatedPen> pen;
  std::shared_ptr<pen::SimulatedClock> clock = std::make_shared<pen::SimulatedClock>();
  GatedStep step;
  std::unique_ptr<pen::HidTransport> transport = std::make_unique<pen::SimulatedTransport>(pen, clock);
  pen::RifflerModel model;
  SimulatedConnector connector{pen, clock, model};
  pen::DriverLoop loop{model, step, connector, *clock, std::move(transport)};
  Pose home{};
};

}  // namespace riffler::test
