#include "stress/orienting_run.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "geom/math.hpp"
#include "pen/models/riffler_model.hpp"
#include "pen/simulated/simulated_transport.hpp"
#include "riffler/collide/collider.hpp"
#include "riffler/plan/orientation.hpp"
#include "riffler/session/orient_loop.hpp"
#include "riffler/tool/cutters.hpp"
#include "stress/pen_run.hpp"

namespace riffler::stress {

namespace {

constexpr int kStepsPerFrame = 33;  // steps
constexpr int kDepth = 16;          // steps between two computations of the true depth
constexpr double kRadius = 3, kFrom = 2, kTo = 38, kLength = 40;

/// An L extruded along x: floor at z = 0 for y > 0, wall at y = 0 up to z = 60.
Mesh corner() {
  const Vec2 outline[] = {{80, 0}, {0, 0}, {0, 60}, {-20, 60}, {-20, -20}, {80, -20}};
  Mesh out;
  for (const double x : {0.0, kLength})
    for (const Vec2& p : outline) out.vertices.emplace_back(x, p.x, p.y);
  for (int k = 0; k < 6; ++k) {
    const int next = (k + 1) % 6;
    out.triangles.emplace_back(k, next, next + 6), out.triangles.emplace_back(k, next + 6, k + 6);
  }
  for (const Vec3i& t : {Vec3i(0, 1, 4), Vec3i(0, 4, 5), Vec3i(1, 2, 3), Vec3i(1, 3, 4)}) {
    out.triangles.emplace_back(t.x + 6, t.y + 6, t.z + 6);
    out.triangles.emplace_back(t.x, t.z, t.y);
  }
  return out;
}

plan::PencilPath edge() {
  plan::PencilPath path;
  path.radius = kRadius;
  for (double x = kFrom; x <= kTo; ++x) {
    path.centres.emplace_back(x, kRadius, kRadius);
    path.contacts.push_back({Vec3(x, kRadius, 0), Vec3(x, 0, kRadius)});
    path.normals.push_back({Vec3(0, 0, 1), Vec3(0, 1, 0)});
  }
  return path;
}

/// A hand that moves to and fro with incommensurate frequencies and presses a button now and then, every third time the
/// one that deletes.
pen::HandPath turning(const Pose& home) {
  return [home](double t) {
    const double s = std::max(0.0, t - 1);
    pen::HandWish wish{.pose = home};
    wish.pose.tip += Vec3(12 * std::sin(0.7 * s), 3 * std::sin(1.9 * s), 3 * std::sin(2.3 * s));
    const Vec3 turn(0.7 * std::sin(1.1 * s) + 0.1 * std::sin(7 * s), 0.4 * std::sin(0.8 * s), 0);
    wish.pose.axis = geom::rotate_by(home.axis, turn);
    if (s > 0 && std::fmod(s, 1.7) < 0.2) wish.buttons = std::fmod(s, 5.1) < 1.7 ? 2 : 1;
    return wish;
  };
}

/// The keys of the path, as in a session.
class Keys {
 public:
  explicit Keys(plan::PencilPath given) : given_(std::move(given)) {}

  void apply(const session::KeyPress& press, OrientingRun& run) {
    const auto here = static_cast<std::size_t>(std::lround(press.station));
    if (press.deletes) {
      if (keys_.empty()) return static_cast<void>(++run.refused);
      const auto away = [&](const auto& key) { return std::abs(static_cast<double>(key.first) - press.station); };
      keys_.erase(std::ranges::min_element(keys_, {}, away)->first);
      ++run.deleted;
    } else {
      keys_[here] = press.axis;
      ++run.set;
    }
    path_ = keys_.empty() ? given_ : plan::oriented(given_, keys_, plan::Interpolation::Smooth);
  }

 private:
  plan::PencilPath given_, path_;
  plan::OrientationKeys keys_;
};

/// Evaluates the ticks of a frame.
class Watch {
 public:
  Watch(const collide::Collider& obstacles, const Tool& tool, double warm, OrientingRun& run)
      : obstacles_(obstacles), assembly_(tool), warm_(warm), run_(run) {}

  void see(const session::OrientTick& tick) {
    ++run_.steps, run_.missed += tick.missed || !geom::finite(tick.tool.tip);
    run_.account = std::min(run_.account, tick.energy);
    run_.greatest = std::max(run_.greatest, glm::length(tick.wrench.torque));
    run_.touched += tick.touch.has_value() && *tick.touch != collide::Touch::Cutter;
    if (tick.time > warm_) run_.step_seconds.push_back(static_cast<float>(tick.seconds));
    if (run_.steps % kDepth != 0) return;
    const double depth = -obstacles_.nearest(assembly_, tick.tool).distance;
    run_.deepest = std::max(run_.deepest, depth), run_.understated += depth > tick.depth + 1e-6;
  }

 private:
  const collide::Collider& obstacles_;
  collide::Assembly assembly_;
  double warm_;
  OrientingRun& run_;
};

collide::Collider obstacles() {
  std::vector<Volume> clamp;
  clamp.push_back(Volume::block({{{10, 14, 8}, {30, 30, 40}}, 0.5, "xyz"}));
  return collide::Collider(corner(), std::move(clamp));
}

}  // namespace

OrientingRun orienting_run(const OrientingOptions& options) {
  OrientingRun run;
  run.account = 1e300;
  run.step_seconds.reserve(static_cast<std::size_t>(1100 * options.seconds));
  const Pose home = pen::SimulatedPen(pen::SimulatedPenSettings()).arms().posture().pose;
  const auto pen = std::make_shared<pen::SimulatedPen>(pen::SimulatedPenSettings(), turning(home));
  const auto clock = std::make_shared<pen::SimulatedClock>();
  auto transport = std::make_unique<pen::SimulatedTransport>(pen, clock);
  pen::RifflerModel model(*transport);
  model.home();

  const collide::Collider hit = obstacles();
  const Tool tool = cutters::ball(2 * kRadius, 20).with_shank({{20, 5, 60, 5}});
  const plan::PencilPath path = edge();
  session::OrientSettings settings;
  settings.passivity = model.passivity();
  const Vec3 axis(0, std::sin(0.15), std::cos(0.15));
  session::OrientLoop loop(settings, tool, session::PathGuide(path, tool, path.size() / 2, axis, settings.slides), hit,
                           model.capability(), false);
  StepCosts costs;
  CountedStep counted(loop, options.allocations, options.warm, costs);
  NeverGone connector;
  pen::DriverLoop driver(model, counted, connector, *clock, std::move(transport));
  ContactGain contacts;
  pen->on_turn = [&] { contacts.add(*pen); };

  Keys keys(path);
  Watch watch(hit, tool, options.warm, run);
  double next_look = 0;
  for (int k = 0; clock->now() < options.seconds; ++k) {
    driver.tick();
    pen->advance(std::llround(1e6 * clock->now()));
    if (k % kStepsPerFrame != 0) continue;
    for (session::OrientTick tick; loop.take(tick);) watch.see(tick);
    for (session::KeyPress press; loop.take(press);) keys.apply(press, run);
    if (clock->now() < next_look) continue;
    next_look += options.seconds / 10;
    run.resident.push_back(resident_mb());
    options.progress(clock->now() / options.seconds);
  }
  run.resident.push_back(resident_mb());
  run.gained = contacts.gained, run.taken = -pen->arms().energy().motors;
  run.allocations = costs.allocations, run.from_system = costs.from_system;
  run.dropped = loop.dropped_ticks() + loop.dropped_presses();
  return run;
}

}  // namespace riffler::stress
