#include "bench/haptic_run.hpp"

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>

#include "base/own_thread.hpp"
#include "bench/contact_scene.hpp"
#include "bench/interpolated_wrench.hpp"
#include "riffler/base/check.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::bench {

namespace {

constexpr double kTick = 1e-3;
constexpr int kSquares = 316;
const Vec3 kLeaning = glm::normalize(Vec3(0.1, 0.05, 1));

struct HapticScene {
  Tool tool;
  std::unique_ptr<Volume> stock;
  std::unique_ptr<sweep::MoveCarver> carver;
  std::unique_ptr<collide::Collider> collider;
  std::function<Pose(double)> grip;  // of s

  void add_stock(const Box3& box, double pitch, double constant) {
    stock = std::make_unique<Volume>(Volume::block({box, pitch, "z"}));
    carver = std::make_unique<sweep::MoveCarver>(*stock, tool, sweep::MoveCarver::Options{0.01, constant});
  }
};

HapticScene cut(double pitch) {
  HapticScene s{cutters::ball(20, 60), {}, {}, {}, {}};
  s.add_stock({{0, 0, -30}, {102.4, 102.4, 0}}, pitch, 5e-6);
  s.grip = [](double t) {
    const double way = 500 * t, radius = std::max(10.0, 36 - 0.06 * way), angle = way / 30,
                 tilt = 0.2 * std::sin(9 * t);
    return Pose{{51.2 + radius * std::cos(angle), 51.2 + radius * std::sin(angle), -10},
                {std::sin(tilt), 0, std::cos(tilt)}};
  };
  return s;
}

HapticScene wave(double pitch, double speed) {
  HapticScene s{cutters::ball(8, 40), {}, {}, {}, {}};
  s.add_stock({{0, 0, -20}, {40, 40, 0}}, pitch, 1e-3 / speed);
  s.grip = [speed](double seconds) {
    const double t = speed * seconds;
    return Pose{{8 + 20 * t, 20 + 2 * std::sin(11 * t), 0.5 - 1.5 * std::sin(17 * t) - 1.5 * t}, {0, 0, 1}};
  };
  return s;
}

/// Sideways into a block, which it enters from the side, 1 to 3 mm deep, leaning to and fro.
HapticScene slot(double pitch, double speed, const Tool& tool) {
  HapticScene s{tool, {}, {}, {}, {}};
  s.add_stock({{0, 12, -20}, {40, 28, 0}}, pitch, 2e-3 / speed);
  s.grip = [speed](double seconds) {
    const double t = speed * seconds, tilt = 0.15 * std::sin(7 * t), turn = 0.1 * std::sin(5 * t);
    return Pose{{-4 + 30 * t, 20 + 1.5 * std::sin(6 * t), -2 + std::cos(13 * t)},
                glm::normalize(Vec3(std::sin(tilt), std::sin(turn), 1))};
  };
  return s;
}

HapticScene trace(double pitch, bool fixture) {
  const std::vector<ContactTool> tools = contact_tools();
  HapticScene s{tools[0].tool, {}, {}, {}, {}};
  const Mesh part = valleys(kSquares);
  std::vector<Volume> fixtures;
  if (fixture) fixtures.push_back(Volume::block({{{20, 30, 55}, {80, 40, 75}}, pitch, "z"}));
  s.collider = std::make_unique<collide::Collider>(part, std::move(fixtures));
  s.grip = [part](double t) {
    const double x = 20 + 50 * t, y = 55 + 3 * std::sin(5 * t);
    return Pose{{x, y, valley_height(part, kSquares, x, y) - 1}, kLeaning};
  };
  return s;
}

HapticScene scene_of(const HapticOptions& o) {
  if (o.scene == "cut") return cut(o.pitch);
  if (o.scene == "wave") return wave(o.pitch, o.speed);
  if (o.scene == "slot") return slot(o.pitch, o.speed, cutters::flat(6, 40));
  if (o.scene == "groove") return slot(o.pitch, o.speed, cutters::fillet(6, 1, 40));
  if (o.scene == "trace" || o.scene == "fixture") return trace(o.pitch, o.scene == "fixture");
  throw std::invalid_argument("scene: there is no \"" + o.scene + '"');
}

}  // namespace

HapticRun haptic_run(const HapticOptions& o) {
  if (o.period < 1) throw std::invalid_argument("period must be at least 1");
  base::require_positive(o.speed, "speed");
  HapticScene scene = scene_of(o);
  haptics::SculptSettings settings;
  settings.parts = o.parts, settings.queries = o.queries, settings.memory = o.memory, settings.budget = o.budget;
  settings.most.linear *= o.period, settings.most.angular = std::min(1.0, settings.most.angular * o.period);
  haptics::SculptStep step(settings, scene.tool, scene.carver.get(), scene.collider.get());
  step.place(scene.grip(0));
  InterpolatedWrench line(o.period * kTick);
  HapticRun out;
  for (int k = 1; k <= o.steps; ++k) {
    const Pose grip = scene.grip(k * kTick);
    out.grip.push_back(grip.tip);
    if (k % o.period == 0) {
      const double dt = o.period * kTick;
      const Pose before = scene.grip(k * kTick - dt);
      const haptics::PoseError way = haptics::pose_error(grip, before);
      const double start = base::thread_seconds();
      const haptics::SculptStep::Result r = step.step(grip, {1 / dt * way.translation, 1 / dt * way.rotation}, dt);
      out.seconds.push_back(base::thread_seconds() - start);
      line.computed(r.on_grip);
      out.removed += r.removed, out.held += r.held, out.touching += step.contact().depth > 0;
      if (o.period == 1) out.force.push_back(r.on_grip.force);
    }
    if (o.period > 1) out.force.push_back(line.tick(kTick).force);
  }
  const auto made = static_cast<double>(out.seconds.size());
  out.held /= made, out.touching /= made;
  return out;
}

}  // namespace riffler::bench
