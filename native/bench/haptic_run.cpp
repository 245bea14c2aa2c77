#include "bench/haptic_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>

#include "base/own_thread.hpp"
#include "bench/contact_parts.hpp"
#include "bench/contact_scene.hpp"
#include "bench/interpolated_wrench.hpp"
#include "riffler/base/check.hpp"
#include "riffler/haptics/sculpt_step.hpp"
#include "riffler/mesh/io/io.hpp"
#include "riffler/plan/pencil.hpp"
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

/// A tool that enters a block from the side, cuts a slot 1 to 3 mm deep and leans to and fro.
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

constexpr double kTraceSpeed = 50, kPressed = 1, kFileSize = 100;  // mm/s, mm, mm

/// The pose of a ball whose centre is pressed kPressed mm from `centre` against the direction `from`.
Pose pressed(const Tool& ball, const Vec3& centre, const Vec3& from, const Vec3& axis) {
  return {centre - kPressed * from - 0.5 * ball.diameter() * axis, axis};
}

/// A tool that circles down in the bore, its axis nearly along it.
HapticScene bore_scene() {
  HapticScene s{contact_tools()[0].tool, {}, {}, {}, {}};
  s.collider = std::make_unique<collide::Collider>(contact_mesh("bore"));
  s.grip = [ball = s.tool](double t) {
    const double room = kBoreRadius - 0.5 * ball.diameter(), angle = kTraceSpeed * t / room;
    const Vec3 from(-std::cos(angle), -std::sin(angle), 0);
    return pressed(ball, Vec3(0, 0, 50 - 8 * t) - room * from, from, glm::normalize(0.1 * from + Vec3(0, 0, 1)));
  };
  return s;
}

/// A corner of the path of the ball's centre, and the direction away from the part there.
struct TraceCorner {
  Vec3 centre, from;
};

/// A motion along straight lines from corner to corner at constant speed.
std::function<Pose(double)> along(const Tool& ball, std::vector<TraceCorner> corners) {
  return [ball, corners = std::move(corners)](double t) {
    double left = kTraceSpeed * t;
    std::size_t k = 0;
    for (; k + 2 < corners.size(); ++k) {
      const double length = glm::length(corners[k + 1].centre - corners[k].centre);
      if (left <= length) break;
      left -= length;
    }
    const TraceCorner &a = corners[k], &b = corners[k + 1];
    const double share = std::min(1.0, left / std::max(1e-9, glm::length(b.centre - a.centre)));
    const Vec3 from = glm::normalize(a.from + share * (b.from - a.from));
    return pressed(ball, a.centre + share * (b.centre - a.centre), from, glm::normalize(from + Vec3(0.02, 0.01, 0.3)));
  };
}

/// A ball that goes twice around the upper edges of the box of 60 × 40 × 30 mm, touching both sides of each edge.
HapticScene box_scene() {
  HapticScene s{contact_tools()[0].tool, {}, {}, {}, {}};
  s.collider = std::make_unique<collide::Collider>(contact_mesh("box"));
  std::vector<TraceCorner> corners;
  const double r = 0.5 * s.tool.diameter() / std::sqrt(3.0);
  for (int k = 0; k <= 8; ++k) {
    const int at = k % 4;
    const double x = at == 1 || at == 2 ? 1 : -1, y = at >= 2 ? 1 : -1;
    const Vec3 from = glm::normalize(Vec3(x, y, 1));
    corners.push_back({Vec3(30 + 30 * x, 20 + 20 * y, 30) + r * Vec3(x, y, 1), from});
  }
  s.grip = along(s.tool, std::move(corners));
  return s;
}

/// A ball that follows the pencil paths of a part scaled to 100 mm length, the longest path first.
HapticScene traced_file(const std::string& name) {
  HapticScene s{contact_tools()[0].tool, {}, {}, {}, {}};
  Mesh part = mesh::read_mesh(name);
  Box3 box;
  for (const Vec3& v : part.vertices) box.add(v);
  const Vec3 size = box.size();
  const double scale = kFileSize / std::max({size.x, size.y, size.z});
  for (Vec3& v : part.vertices) v = scale * (v - box.lower);
  std::vector<plan::PencilPath> paths = plan::pencil(part, 0.5 * s.tool.diameter()).paths;
  if (paths.empty()) throw std::invalid_argument("scene: " + name + " has no valley for the ball");
  std::ranges::sort(paths, std::ranges::greater{}, &plan::PencilPath::length);
  std::vector<TraceCorner> corners;
  for (const plan::PencilPath& path : paths)
    for (std::size_t k = 0; k < path.size(); ++k) {
      const Vec3 sum = path.normals[k][0] + path.normals[k][1];
      corners.push_back({path.centres[k], glm::length(sum) > 1e-3 ? glm::normalize(sum) : path.normals[k][0]});
    }
  s.collider = std::make_unique<collide::Collider>(part);
  s.grip = along(s.tool, std::move(corners));
  return s;
}

HapticScene scene_of(const HapticOptions& o) {
  if (o.scene == "cut") return cut(o.pitch);
  if (o.scene == "wave") return wave(o.pitch, o.speed);
  if (o.scene == "slot") return slot(o.pitch, o.speed, cutters::flat(6, 40));
  if (o.scene == "groove") return slot(o.pitch, o.speed, cutters::fillet(6, 1, 40));
  if (o.scene == "trace" || o.scene == "fixture") return trace(o.pitch, o.scene == "fixture");
  if (o.scene == "bore") return bore_scene();
  if (o.scene == "box") return box_scene();
  if (std::filesystem::exists(o.scene)) return traced_file(o.scene);
  throw std::invalid_argument("scene: unknown scene \"" + o.scene + '"');
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
