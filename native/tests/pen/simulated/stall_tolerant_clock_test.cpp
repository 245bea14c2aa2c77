// The clock of the simulated device on a system that a test moves: smooth, late, and late in the middle of things.
#include "pen/simulated/stall_tolerant_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <tuple>

#include "pen/simulated/simulated_bench.hpp"

namespace riffler::pen::stall_tolerant_clock_test {
namespace {

using test::GatedStep;

constexpr double kMax = 5e-4;

/// A system whose every wait and every `busy`th look takes `late` s longer.
struct Machine {
  double time = 100, late = 0;
  int busy = 0, looks = 0;

  double now() { return time += busy > 0 && ++looks % busy == 0 ? late : 0; }
  std::unique_ptr<StallTolerantClock> clock() {
    return std::make_unique<StallTolerantClock>(
        kMax, StallTolerantClock::System{[this] { return now(); }, [this](double seconds) { time += seconds + late; }});
  }
};

TEST(StallTolerantClock, IsTheSystemsClockOnAMachineThatKeepsUp) {
  Machine machine;
  const auto clock = machine.clock();
  for (int k = 0; k < 1000; ++k) {
    machine.time += 0.3e-3;
    EXPECT_NEAR(clock->now(), machine.time, 1e-9);
    clock->wait(0.7e-3);
    EXPECT_NEAR(clock->last(), machine.time, 1e-9);
  }
}

TEST(StallTolerantClock, StandsStillWhileTheMachineDoes) {
  Machine machine;
  const auto clock = machine.clock();
  const double start = clock->now();
  machine.time += 3;
  EXPECT_NEAR(clock->now(), start + kMax, 1e-9);
  EXPECT_EQ(clock->now(), clock->last());
  machine.late = 0.05;
  clock->wait(2e-3);
  EXPECT_NEAR(clock->last(), start + 2 * kMax + 2e-3, 1e-9);
}

TEST(StallTolerantClock, NeverRunsBackwards) {
  Machine machine;
  const auto clock = machine.clock();
  const double start = clock->now();
  for (const double seconds : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) clock->wait(seconds);
  machine.time -= 10;
  EXPECT_EQ(clock->now(), start);
  machine.time += 1e-4;
  EXPECT_NEAR(clock->now(), start + 1e-4, 1e-9);
}

/// The whole stack on a machine that stands still for 80 ms again and again: the hand that holds its button is pushed
/// all the same, and nothing trips. On the system's own time, the same machine lets through nothing for long.
TEST(StallTolerantClock, NoForceIsLostOnAMachineThatIsLate) {
  struct Nobody final : Connector {
    void begin() noexcept override {}
    Answer poll(std::unique_ptr<Transport>&, OpenProblem&) noexcept override { return Answer::Pending; }
  };
  const auto pushed = [](double most, int ticks_of_loop) {
    Machine machine{.late = 0.08, .busy = 29};
    std::shared_ptr<Clock> clock = std::make_shared<StallTolerantClock>(
        most, StallTolerantClock::System{[&] { return machine.now(); }, [&](double s) { machine.time += s; }});
    auto pen = std::make_shared<SimulatedPen>(SimulatedPenSettings{});
    auto transport = std::make_unique<SimulatedTransport>(pen, clock, clock->now());
    RifflerModel model(*transport);
    model.home();
    GatedStep step;
    int ticks = 0, pushes = 0;
    double longest = 0;
    step.law = [&](const PenSample&, double, double dt) {
      longest = std::max(longest, dt);
      return Wrench{{0, 0, 0.3}, {}};
    };
    step.after = [&](const Wrench& wrench) { ++ticks, pushes += wrench.force.z > 0.29; };
    Nobody nobody;
    DriverLoop loop(model, step, nobody, *clock, std::move(transport));
    for (int k = 0; k < ticks_of_loop; ++k) loop.tick();
    return std::tuple(static_cast<double>(pushes) / ticks, longest, step.safety.log().count());
  };
  const auto [share, longest, trips] = pushed(kMax, 4000);
  EXPECT_GT(share, 0.8);
  EXPECT_LT(longest, 3e-3);
  EXPECT_EQ(trips, 0u);
  EXPECT_LT(std::get<0>(pushed(1e3, 100)), 0.1) << "a machine that this test does not tell from a good one";
}

}  // namespace
}  // namespace riffler::pen::stall_tolerant_clock_test
