#include "stress/sculpting_run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "pen/models/riffler_model.hpp"
#include "pen/simulated/simulated_transport.hpp"
#include "riffler/marching/mesher.hpp"
#include "riffler/session/journal_rules.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/checks.hpp"
#include "stress/pen_run.hpp"

namespace riffler::stress {

namespace {

const Box3 kBox{{-40, -40, -30}, {40, 40, 0}};
constexpr int kFrame = 33;  // steps

/// A hand that wanders over ±15 mm of the pen, twice as much of the tool, with incommensurate frequencies, and ever
/// deeper.
pen::HandPath wandering(const Pose& home, double seconds, double pressed) {
  return [home, seconds, pressed](double t) {
    const double s = std::max(0.0, t - 1);
    pen::HandWish wish{.pose = home};
    wish.pose.tip += Vec3(15 * std::sin(0.9 * s), 15 * std::sin(1.13 * s + 1) - 15 * std::sin(1.0),
                          -3 - 5 * s / seconds + 2 * std::sin(2.3 * s));
    const Vec3 lean(0.2 * std::sin(0.7 * s), 0.2 * std::sin(0.41 * s), 0);
    wish.pose.axis = glm::normalize(home.axis + std::min(1.0, s) * lean);
    wish.buttons = s > 0 && std::fmod(s, 3) < pressed ? 1 : 0;
    return wish;
  };
}

/// Carves every move a second time, one by one, like the replay of a journal.
class Again final : public session::StrokeSink {
 public:
  Again(const Volume& stock, const Tool& tool, const sweep::MoveCarver::Options& options)
      : volume(stock), carver_(volume, tool, options) {}
  bool room() noexcept override { return true; }
  void begin(double, const Pose& tool) noexcept override { last_ = tool; }
  void row(double, const Pose& tool, const Wrench&, double) noexcept override {
    moves_.push_back({last_, tool}), last_ = tool;
  }
  void end() noexcept override {}
  void undo(std::size_t) noexcept override {}
  void redo(std::size_t) noexcept override {}
  /// Call it outside the thread's step.
  void catch_up() {
    for (const auto& [from, to] : moves_)
      if (!session::stands(from, to)) carver_.move(from, to, 1e-3);
    moves_.clear();
  }

  Volume volume;

 private:
  sweep::MoveCarver carver_;
  Pose last_;
  std::vector<std::pair<Pose, Pose>> moves_ = reserved();
  static std::vector<std::pair<Pose, Pose>> reserved() {
    std::vector<std::pair<Pose, Pose>> out;
    out.reserve(4 * kFrame);
    return out;
  }
};

void take_ticks(session::SculptLoop& loop, const SculptingOptions& options, SculptingRun& run) {
  for (session::SculptTick tick; loop.take(tick);) {
    ++run.steps, run.missed += tick.missed;
    run.removed += tick.removed;
    run.touched += !tick.cutting && glm::length(tick.wrench.force) > 0.2;
    run.account = std::min(run.account, tick.energy);
    run.greatest = std::max(run.greatest, glm::length(tick.applied.force));
    if (tick.time > options.warm) run.step_seconds.push_back(static_cast<float>(tick.seconds));
  }
}

}  // namespace

SculptingRun sculpting_run(const SculptingOptions& options) {
  SculptingRun run;
  run.step_seconds.reserve(static_cast<std::size_t>(1100 * options.seconds));
  run.account = 1e300;
  pen::SimulatedPenSettings simulated;
  simulated.cable.jitter_us = options.jitter_us;
  const Pose home = pen::SimulatedPen(simulated).arms().posture().pose;
  const auto pen =
      std::make_shared<pen::SimulatedPen>(simulated, wandering(home, options.seconds, options.touch ? 1.0 : 2.4));
  const auto clock = std::make_shared<pen::SimulatedClock>();
  auto transport = std::make_unique<pen::SimulatedTransport>(pen, clock);
  pen::RifflerModel model(*transport);
  model.home();

  const Tool ball = cutters::ball(6, 30);
  const Volume stock = Volume::block({kBox, options.pitch, options.directions});
  session::SculptLoopSettings settings;
  settings.workspace.scale = 2;
  settings.carving.removal_constant = 0.01;
  settings.sculpt.coupling.stiffness = options.stiffness;
  settings.passivity = model.passivity();
  settings.touch = options.touch;
  if (!options.controlled) settings.passivity.reserve = settings.passivity.storage = 1e9;
  Again again(stock, ball, settings.carving);
  session::SculptLoop loop(settings, stock, ball, nullptr, model.capability(), Pose{{0, 0, 3}, {0, 0, 1}}, &again);
  StepCosts costs;
  CountedStep counted(loop, options.allocations, options.warm, costs);
  NeverGone connector;
  pen::DriverLoop driver(model, counted, connector, *clock, std::move(transport));
  ContactGain contacts;
  pen->on_turn = [&] { contacts.add(*pen); };

  Volume shown = stock;
  marching::Mesher mesher(shown);
  base::BlockReserve reserve;
  std::vector<session::SculptLoop::Place> places;
  double next_look = 0;
  for (int k = 0; clock->now() < options.seconds; ++k) {
    driver.tick();
    pen->advance(std::llround(1e6 * clock->now()));
    if (k % kFrame != 0) continue;
    places.clear();
    run.strokes = loop.show(shown, places, 0).strokes;
    run.tiles += places.size(), ++run.frames;
    again.catch_up();
    mesher.update(shown);
    reserve.fill(1 << 17, 64);
    take_ticks(loop, options, run);
    if (clock->now() < next_look) continue;
    next_look += options.seconds / 10;
    run.resident.push_back(resident_mb());
    options.progress(clock->now() / options.seconds);
  }
  loop.finish();
  loop.show(shown, places, 0);
  again.catch_up();
  take_ticks(loop, options, run);
  run.resident.push_back(resident_mb());
  run.gained = contacts.gained, run.given = -pen->arms().energy().motors;
  run.allocations = costs.allocations, run.from_system = costs.from_system;
  run.trips = loop.trips().count();
  run.replayed = check_same_bytes(shown, again.volume).empty();
  mesher.update(shown);
  run.triangles = mesher.triangles();
  return run;
}

}  // namespace riffler::stress
