// A simulated pen that sculpts, on a virtual clock: firmware, cable, driver's loop and sculpting loop.
#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "pen/simulated/simulated_bench.hpp"
#include "riffler/session/journal_rules.hpp"
#include "riffler/session/sculpt_loop.hpp"

namespace riffler::test {

inline const Box3 kStock{{-30, -30, -20}, {30, 30, 0}};

inline Volume sculpt_stock(double pitch = 0.25, const char* directions = "z") {
  return Volume::block({kStock, pitch, directions});
}

/// What a sink was told.
class RememberingSink final : public session::StrokeSink {
 public:
  struct Stroke {
    std::vector<Pose> poses;
    std::vector<double> times, removed;
  };

  bool room() noexcept override { return has_room; }
  void begin(double time, const Pose& tool) noexcept override { strokes.push_back({{tool}, {time}, {0}}); }
  void row(double time, const Pose& tool, const Wrench&, double removed) noexcept override {
    strokes.back().poses.push_back(tool), strokes.back().times.push_back(time);
    strokes.back().removed.push_back(removed);
  }
  void end() noexcept override { ++ended; }
  void undo(std::size_t n) noexcept override { taken_back += n; }
  void redo(std::size_t n) noexcept override { brought_back += n; }

  std::vector<Stroke> strokes;
  std::size_t ended = 0, taken_back = 0, brought_back = 0;
  bool has_room = true;
};

/// The same strokes move by move, from the stock on.
inline Volume carved_again(const Volume& stock, const Tool& tool, const std::vector<RememberingSink::Stroke>& strokes,
                           const sweep::MoveCarver::Options& options = {}) {
  Volume volume = stock;
  sweep::MoveCarver carver(volume, tool, options);
  for (const auto& stroke : strokes)
    for (std::size_t k = 1; k < stroke.poses.size(); ++k) {
      const Pose &from = stroke.poses[k - 1], &to = stroke.poses[k];
      if (!session::stands(from, to)) carver.move(from, to, 1e-3);
    }
  return volume;
}

/// Homed; the hand follows `path`, whose poses are the pen's.
struct SculptBench {
  SculptBench(pen::HandPath path, const Volume& stock, const Tool& tool,
              const session::SculptLoopSettings& settings = {}, session::StrokeSink* sink = nullptr,
              const collide::Collider* obstacles = nullptr, const Pose& start = {{0, 0, 3}, {0, 0, 1}})
      : pen(std::make_shared<pen::SimulatedPen>(pen::SimulatedPenSettings(), std::move(path))),
        loop(of_this_pen(settings), stock, tool, obstacles, model.capability(), start, sink) {
    model.home();
  }

  session::SculptLoopSettings of_this_pen(session::SculptLoopSettings settings) const {
    settings.passivity = model.passivity();
    return settings;
  }

  /// Ticks for so long since the end of the last run, each given to visit.
  template <class Visit>
  void run(double seconds, const Visit& visit) {
    end += seconds;
    while (clock->now() < end) {
      driver.tick();
      pen->advance(std::llround(1e6 * clock->now()));
      for (session::SculptTick tick; loop.take(tick);) visit(tick);
    }
  }
  void run(double seconds) {
    run(seconds, [](const session::SculptTick&) {});
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
  session::SculptLoop loop;
  pen::DriverLoop driver{model, loop, connector, *clock, std::move(transport)};
};

inline Pose pen_home() {
  return pen::SimulatedPen(pen::SimulatedPenSettings()).arms().posture().pose;
}

/// From a second on the grip circles 3 to 5 mm deeper than it began, and the button is held for two of every three
/// seconds; the tool leans a little.
inline pen::HandPath sculpting_hand(double depth = 4, double radius = 10) {
  return [home = pen_home(), depth, radius](double t) {
    const double s = std::max(0.0, t - 1);
    pen::HandWish wish{.pose = home};
    wish.pose.tip += Vec3(radius * std::sin(2 * s), radius * (1 - std::cos(2 * s)),
                          -depth * std::min(1.0, s) - 0.5 * std::sin(5 * s));
    const double lean = 0.15 * std::sin(s);
    wish.pose.axis = glm::normalize(home.axis + lean * Vec3(1, 0.3, 0));
    wish.buttons = s > 0 && std::fmod(s, 3) < 2 ? 1 : 0;
    return wish;
  };
}

}  // namespace riffler::test
