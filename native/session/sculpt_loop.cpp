#include "riffler/session/sculpt_loop.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/own_thread.hpp"
#include "riffler/base/check.hpp"
#include "riffler/haptics/coupling.hpp"

namespace riffler::session {

void SculptLoopSettings::validate() const {
  sculpt.validate();
  base::require_tolerance(carving.tolerance);
  if (sculpt.parts != 1) throw std::invalid_argument("parts must be 1 in a session: it records a pose for each tick");
  limits.validate();
  passivity.validate();
  safety.validate();
  wrench_extrapolator.validate();
  workspace.validate();
  base::require_positive(touch_force, "touch_force");
}

/// The objects being worked on.
struct SculptLoop::Scene {
  Scene(const SculptLoopSettings& s, const Volume& stock, const Tool& tool, const collide::Collider* obstacles,
        bool absolute)
      : volume(stock),
        carver(volume, tool, deferred(s.carving)),
        step(s.sculpt.at_tool(s.workspace.scale), tool, &carver, obstacles, nullptr, s.touch ? &volume : nullptr),
        workspace(s.workspace.for_device(absolute)) {}

  static sweep::MoveCarver::Options deferred(sweep::MoveCarver::Options carving) {
    carving.deferred = true;  // the display asks 30 times a second, the pen cuts 1000 times
    return carving;
  }

  Volume volume;
  sweep::MoveCarver carver;
  haptics::SculptStep step;
  haptics::Workspace workspace;
};

SculptLoop::SculptLoop(const SculptLoopSettings& settings, const Volume& stock, const Tool& tool,
                       const collide::Collider* obstacles, const pen::DeviceCapability& device,
                       const std::optional<Pose>& start, StrokeSink* sink)
    : PenLoop((settings.validate(), settings), device, start.value_or(Pose{}), !start),
      settings_(settings),
      sink_(sink),
      scene_(std::make_unique<Scene>(settings, stock, tool, obstacles, !start)),
      touch_share_(std::min(1.0, settings.touch_force / settings.limits.wrench.linear)),
      exchange_(stock),
      dead_man_mask_(settings.workspace.dead_man_mask) {}

SculptLoop::~SculptLoop() = default;

haptics::SafeWrench SculptLoop::step(const pen::PenSample& sample, double now, double dt) noexcept {
  const double start = base::thread_seconds();
  SculptTick tick = begin(sample, now, dt, force_mask());
  tick.applied = gate_.applied();
  const Wrench wanted = sculpt(sample, dt, tick);
  const haptics::SafeWrench safe = release(sample, wanted, dt, tick);
  if (tick.cutting && sink_) sink_->row(tick.time, tick.tool, tick.wrench, tick.removed);
  tick.seconds = base::thread_seconds() - start;
  put(tick);
  return safe;
}

/// Buttons of which one must be held for force; 0: none.
std::uint32_t SculptLoop::force_mask() const noexcept {
  const std::uint32_t mask = dead_man_mask_.load();
  if (!settings_.touch) return mask;
  return settings_.touch_mask == 0 ? 0 : mask | settings_.touch_mask;
}

/// The tool's step, and the resulting wrench on the hand.
Wrench SculptLoop::sculpt(const pen::PenSample& sample, double dt, SculptTick& tick) noexcept {
  tick.from = tick.tool = last_tool_;
  if (dt > 0 && std::isfinite(dt)) owed_ += dt;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return missed(dt, nullptr, tick);
  Scene& scene = *scene_;
  const haptics::ForceState state = gate_.state();
  Wrench out;
  if (!in_stroke_) tell_undo();
  if (!sure(state)) {
    end_stroke();
    placed_ = false;
  } else {
    if (!std::exchange(placed_, true)) place(scene, sample);
    const std::uint32_t mask = dead_man_mask_.load();
    const bool wants = lets_force_through(state) && (mask == 0 || (sample.buttons & mask) != 0),
               room = !sink_ || sink_->room();
    if (wants && !room) tick.problem = "the journal has no room, so nothing is cut";
    if (!(wants && room)) end_stroke();
    out = follow(scene, sample, dt, wants && room, tick);
  }
  if (exchange_.asked()) {
    try {
      serve(scene);
    } catch (const std::exception&) {  // no memory: the next step tries again
    }
  }
  return out;
}

/// Prepares one part of the changes for the display; after the last part hands over all and returns true. If it throws,
/// some tiles may wait for the next call.
bool SculptLoop::serve(Scene& scene) {
  const auto changed = [&] { exchange_.changed(scene.carver.replaced()); };
  if (!scene.carver.publishing()) serving_ = {strokes_, in_stroke_};
  bool done = false;
  try {
    done = scene.carver.publish_part();
  } catch (...) {
    changed();
    throw;
  }
  changed();
  if (done) exchange_.serve(scene.volume, serving_);
  served_.fetch_add(1, std::memory_order_relaxed);
  return done;
}

/// Places the tool at the hand's current pose; the path to it is not cut.
void SculptLoop::place(Scene& scene, const pen::PenSample& sample) noexcept {
  end_stroke();
  if (absolute_) last_tool_ = sample.pose;
  scene.step.place(last_tool_), scene.workspace.place(last_tool_);
  wrench_extrapolator_.reset();
  owed_ = 0;
}

Wrench SculptLoop::follow(Scene& scene, const pen::PenSample& sample, double dt, bool cutting,
                          SculptTick& tick) noexcept {
  try {
    const Pose target = scene.workspace.target(sample.pose, sample.buttons);
    const Twist twist = scene.workspace.to_target({sample.velocity, sample.turning});
    tick.from = last_tool_;
    if (settings_.touch && !cutting && unpublished_) {
      scene.carver.publish();
      exchange_.changed(scene.carver.replaced());
      unpublished_ = false;
    }
    const haptics::SculptStep::Result r = scene.step.step(target, twist, owed_, cutting);
    owed_ = 0;
    if (r.cuts > 0) exchange_.changed(scene.carver.replaced()), unpublished_ = true;
    if (r.cuts > 0 && scene.carver.cut_something() && !in_stroke_) begin_stroke(dt);
    last_tool_ = tick.tool = r.tool;
    tick.on_tool = r.on_tool;
    tick.removed = r.removed, tick.depth = r.depth_bound, tick.cutting = in_stroke_;
    tick.held = r.held;
    if (r.held) {
      tick.problem = haptics::SculptStep::kHeldText;
      held_steps_.fetch_add(1, std::memory_order_relaxed);
    }
    return wrench_extrapolator_.stepped(limited_touch(scene.workspace.to_grip(r.on_grip), dt, cutting), dt);
  } catch (const std::bad_alloc&) {
    exchange_.changed(scene.carver.replaced());
    return missed(dt, "there is no memory for the next cut", tick);
  } catch (const std::exception&) {
    return missed(dt, "the step failed", tick);
  }
}

/// Limits the wrench while the tool touches without cutting. The limits change only as fast as a force may rise or
/// fall.
Wrench SculptLoop::limited_touch(const Wrench& on_hand, double dt, bool cutting) noexcept {
  if (!settings_.touch || !(dt > 0)) return on_hand;
  const haptics::Bounds& most = settings_.limits.wrench;
  const double least = std::min(1.0, settings_.touch_force / most.linear);
  touch_share_ = cutting ? std::min(1.0, touch_share_ + dt / settings_.safety.ramp)
                         : std::max(least, touch_share_ - dt / settings_.safety.fall);
  const double force = glm::length(on_hand.force), torque = glm::length(on_hand.torque);
  double share = 1;
  if (force > touch_share_ * most.linear) share = touch_share_ * most.linear / force;
  if (torque > touch_share_ * most.angular) share = std::min(share, touch_share_ * most.angular / torque);
  return share * on_hand;
}

/// Begins a stroke with the move that has just removed material, from the tool's pose before that move.
void SculptLoop::begin_stroke(double dt) noexcept {
  in_stroke_ = true, ++strokes_;
  if (sink_) sink_->begin(time_ - dt, last_tool_);
}

void SculptLoop::end_stroke() noexcept {
  if (!in_stroke_) return;
  in_stroke_ = false;
  if (sink_) sink_->end();
}

// --- The displaying thread ---

TileExchange::Mark SculptLoop::show(Volume& shown, std::vector<Place>& places, double patience) {
  constexpr double kNap = 1e-4;
  TileExchange::Mark mark;
  exchange_.take(shown, places, mark);  // left over from an earlier call that timed out
  exchange_.ask();
  std::uint32_t served = served_.load(std::memory_order_relaxed);
  for (double waited = 0; waited < patience; waited += kNap) {
    if (exchange_.take(shown, places, mark)) return mark;
    if (const std::uint32_t now = served_.load(std::memory_order_relaxed); now != served) served = now, waited = 0;
    std::this_thread::sleep_for(std::chrono::duration<double>(kNap));
  }
  // The loop is idle or in a long step: copy directly between two steps.
  const std::lock_guard lock(mutex_);
  while (!serve(*scene_)) {
  }
  exchange_.take(shown, places, mark);
  return mark;
}

bool SculptLoop::replace(const Volume& volume, std::int64_t strokes) {
  const std::lock_guard lock(mutex_);
  if (in_stroke_) return false;
  scene_->carver.forget();
  scene_->volume.restore(volume);
  scene_->step.refilled();
  unpublished_ = false;
  brought_back_ += strokes;
  return true;
}

void SculptLoop::finish() noexcept {
  end_stroke();
  tell_undo();
}

/// Called on the thread that makes all other calls of the sink.
void SculptLoop::tell_undo() noexcept {
  const std::int64_t strokes = std::exchange(brought_back_, 0);
  if (sink_ && strokes < 0) sink_->undo(static_cast<std::size_t>(-strokes));
  if (sink_ && strokes > 0) sink_->redo(static_cast<std::size_t>(strokes));
}

void SculptLoop::set_workspace(const haptics::WorkspaceSettings& settings) {
  const std::lock_guard lock(mutex_);
  scene_->workspace.set(settings.for_device(absolute_));
  scene_->step.set_coupling(settings_.sculpt.coupling.at_tool(settings.scale));
  dead_man_mask_.store(settings.dead_man_mask);
}

}  // namespace riffler::session
