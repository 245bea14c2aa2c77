#include "riffler/session/orient_loop.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/own_thread.hpp"

namespace riffler::session {

namespace {

bool has_torque(const pen::DeviceCapability& device) {
  return device[pen::Coordinate::A].pushes && device[pen::Coordinate::B].pushes;
}

}  // namespace

OrientSettings::OrientSettings() {
  // Guidance along the path is weak, collision strong (4.4.3): at most 1.5 N draw the hand to the path.
  step.coupling.stiffness = 0.3;
  step.firmness = 100;
  // The torque stops growing at the limit of the pen's motors; more would only press the tool deeper into obstacles.
  step.coupling.max_turn = limits.wrench.angular / step.coupling.turn_stiffness;
  workspace.dead_man_mask = 0;
  workspace.clutch_mask = 4;
}

void OrientSettings::validate() const {
  step.validate();
  if (step.parts != 1) throw std::invalid_argument("parts must be 1 in a session");
  limits.validate();
  passivity.validate();
  safety.validate();
  wrench_extrapolator.validate();
  workspace.validate();
  if ((set_mask & delete_mask) != 0) throw std::invalid_argument("set_mask must share no button with delete_mask");
  if (((set_mask | delete_mask) & (workspace.clutch_mask | workspace.dead_man_mask)) != 0)
    throw std::invalid_argument("set_mask and delete_mask must share no button with clutch_mask and dead_man_mask");
}

struct OrientLoop::Scene {
  Scene(const OrientSettings& s, const Tool& tool, const PathGuide& on, const collide::Collider& obstacles,
        bool absolute)
      : guide(on),
        step(s.step.at_tool(s.workspace.scale), tool, nullptr, &obstacles, &guide),
        workspace(s.workspace.for_device(absolute)) {
    guide.set_slides(s.slides);
  }
  Scene(const Scene&) = delete;

  PathGuide guide;
  haptics::SculptStep step;
  haptics::Workspace workspace;
};

OrientLoop::OrientLoop(const OrientSettings& settings, const Tool& tool, const PathGuide& guide,
                       const collide::Collider& obstacles, const pen::DeviceCapability& device, bool absolute)
    : PenLoop((settings.validate(), settings), device, guide.pose(), absolute),
      settings_(settings),
      torque_(has_torque(device)),
      last_station_(guide.station()),
      scene_(std::make_unique<Scene>(settings, tool, guide, obstacles, absolute)) {}

OrientLoop::~OrientLoop() = default;

haptics::SafeWrench OrientLoop::step(const pen::PenSample& sample, double now, double dt) noexcept {
  const double start = base::thread_seconds();
  OrientTick tick = begin(sample, now, dt, settings_.workspace.dead_man_mask);
  const Wrench wanted = follow(sample, dt, tick);
  const haptics::SafeWrench safe = release(sample, wanted, dt, tick);
  press(sample.buttons, tick);
  tick.seconds = base::thread_seconds() - start;
  put(tick);
  return safe;
}

/// The tool's step, and the resulting wrench on the hand.
Wrench OrientLoop::follow(const pen::PenSample& sample, double dt, OrientTick& tick) noexcept {
  tick.tool = last_tool_, tick.station = last_station_;
  if (dt > 0 && std::isfinite(dt)) owed_ += dt;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return missed(dt, nullptr, tick);
  if (!sure(gate_.state())) {
    placed_ = false;
    return {};
  }
  Scene& scene = *scene_;
  try {
    if (!std::exchange(placed_, true)) {
      const Pose from = absolute_ ? sample.pose : scene.guide.pose();
      scene.step.place(from), scene.workspace.place(absolute_ ? sample.pose : scene.step.tool());
      wrench_extrapolator_.reset();
      owed_ = 0;
    }
    const Pose target = scene.workspace.target(sample.pose, sample.buttons);
    const Twist twist = scene.workspace.to_target({sample.velocity, sample.turning});
    const haptics::SculptStep::Result r = scene.step.step(target, twist, owed_, false);
    owed_ = 0;
    const collide::Contact& contact = scene.step.contact();
    last_tool_ = tick.tool = r.tool, last_station_ = tick.station = scene.guide.station();
    tick.on_tool = settings_.step.firmness * Wrench{contact.force, contact.torque};
    tick.depth = r.depth_bound, tick.held = r.held;
    if (!contact.touches.empty()) tick.touch = contact.touches.front();
    if (r.held) tick.problem = haptics::SculptStep::kHeldText;
    Wrench on_hand = scene.workspace.to_grip(r.on_grip);
    if (!torque_) on_hand = on_hand + scene.workspace.to_grip({tick.on_tool.force, Vec3(0)});
    return wrench_extrapolator_.stepped(on_hand, dt);
  } catch (const std::exception&) {
    return missed(dt, "the step failed", tick);
  }
}

/// Handles buttons. Call only while the device knows its pose: a key must be where the user sees the tool.
void OrientLoop::press(std::uint32_t buttons, const OrientTick& tick) noexcept {
  const std::uint32_t pressed = buttons & ~std::exchange(buttons_, buttons);
  if (!sure(tick.state)) return;
  for (const bool deletes : {false, true}) {
    if ((pressed & (deletes ? settings_.delete_mask : settings_.set_mask)) == 0) continue;
    const KeyPress press{tick.time, tick.station, tick.tool.axis, deletes};
    if (!presses_.put(press)) dropped_presses_.fetch_add(1, std::memory_order_relaxed);
  }
}

void OrientLoop::go_to(std::size_t point) {
  const std::lock_guard lock(mutex_);
  scene_->guide.go_to(point);
  scene_->step.place(scene_->guide.pose()), scene_->workspace.place(scene_->guide.pose());
}

void OrientLoop::set_slides(bool slides) {
  const std::lock_guard lock(mutex_);
  scene_->guide.set_slides(slides);
}

void OrientLoop::set_workspace(const haptics::WorkspaceSettings& settings) {
  OrientSettings changed = settings_;
  changed.workspace = settings;
  changed.workspace.dead_man_mask = settings_.workspace.dead_man_mask;
  changed.validate();
  const std::lock_guard lock(mutex_);
  scene_->workspace.set(changed.workspace.for_device(absolute_));
  scene_->step.set_coupling(settings_.step.coupling.at_tool(settings.scale));
}

}  // namespace riffler::session
