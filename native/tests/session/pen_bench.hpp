// A simulated pen around the loop of a session, on a virtual clock: firmware, cable, driver's loop and the session's.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "pen/simulated/simulated_bench.hpp"

namespace riffler::test {

inline Pose pen_home() {
  return pen::SimulatedPen(pen::SimulatedPenSettings()).arms().posture().pose;
}

/// Homed; the hand follows `path`, whose poses are the pen's.
struct PenBench {
  explicit PenBench(pen::HandPath path)
      : pen(std::make_shared<pen::SimulatedPen>(pen::SimulatedPenSettings(), std::move(path))) {}

  /// Call it once: `loop` computes the ticks, and must outlive this object.
  void drive(pen::PenStep& loop) {
    driver.emplace(model, loop, connector, *clock, std::move(transport));
    model.home();
  }

  /// Ticks for so long since the end of the last run, each given to visit.
  template <class Tick, class Loop, class Visit>
  void ticks(Loop& loop, double seconds, const Visit& visit) {
    end += seconds;
    while (clock->now() < end) {
      driver->tick();
      pen->advance(std::llround(1e6 * clock->now()));
      for (Tick tick; loop.take(tick);) visit(tick);
    }
  }

  /// The host does nothing for so long.
  void alone(double seconds) {
    clock->wait(seconds);
    pen->advance(std::llround(1e6 * clock->now()));
  }

  double end = 0;
  std::shared_ptr<pen::SimulatedPen> pen;
  std::shared_ptr<pen::SimulatedClock> clock = std::make_shared<pen::SimulatedClock>();
  std::unique_ptr<pen::HidTransport> transport = std::make_unique<pen::SimulatedTransport>(pen, clock);
  pen::RifflerModel model{*transport};
  SimulatedConnector connector{pen, clock, model};
  std::optional<pen::DriverLoop> driver;
};

}  // namespace riffler::test
