#include "pen/pose_follower.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "geom/directions.hpp"
#include "pen/arms/wrench_split.hpp"
#include "pen/driver.hpp"
#include "riffler/base/check.hpp"
#include "riffler/pen/arms/motors.hpp"

namespace riffler::pen {

namespace {

constexpr double kLongest = 3600;     // s of a path
constexpr double kPerSecond = 1100;   // records for which memory is reserved
constexpr double kAxisLength = 1e-6;  // tolerance of unit axes

std::vector<FollowerKey> checked(std::vector<FollowerKey> keys) {
  if (keys.empty()) throw std::invalid_argument("keys: at least one is needed");
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const FollowerKey& key = keys[k];
    const std::string name = "keys, row " + std::to_string(k);
    if (!std::isfinite(key.time) || !geom::finite(key.pose.tip) || !geom::finite(key.pose.axis) ||
        !haptics::finite(key.extra))
      throw std::invalid_argument(name + " must be finite");
    if (std::abs(glm::length(key.pose.axis) - 1) > kAxisLength)
      throw std::invalid_argument(name + ": the axis must have the length 1");
    if (k > 0 && !(key.time > keys[k - 1].time))
      throw std::invalid_argument(name + ": its time must be after that of the row before");
  }
  if (keys.back().time - keys.front().time > kLongest)
    throw std::invalid_argument("keys: the path takes more than an hour");
  const double start = keys.front().time;
  for (FollowerKey& key : keys) key.time -= start;
  return keys;
}

haptics::LimitSettings limits_of(const PenGeometry& pen) {
  haptics::LimitSettings out;
  out.wrench = {pen.force, pen.torque};
  return out;
}

}  // namespace

const char* name(FollowerState state) noexcept {
  switch (state) {
    case FollowerState::Waiting:
      return "waiting";
    case FollowerState::Ramp:
      return "ramp";
    case FollowerState::Moving:
      return "moving";
    case FollowerState::Holding:
      return "holding";
    case FollowerState::Stopped:
      break;
  }
  return "stopped";
}

void FollowerSettings::validate() const {
  coupling.validate();
  require_positive(astray, "astray");
  base::require_between(gravity, 0, 1, "gravity");
  base::require_between(weight, 0, 20, "weight");
  base::require_between(hook, -1000, 1000, "hook");
  base::require_positive(silence, "silence");
}

PoseFollower::PoseFollower(const PenGeometry& geometry, std::vector<FollowerKey> keys, const FollowerSettings& settings)
    : pen_(geometry),
      keys_(checked(std::move(keys))),
      settings_((settings.validate(), settings)),
      capability_(pen_capability(geometry)),
      limits_(limits_of(geometry)),
      safety_(haptics::SafetySettings{}),
      records_(static_cast<std::size_t>(kPerSecond * (keys_.back().time + 1))),
      heard_(steady_seconds()) {
  safety_.switch_on();
}

void PoseFollower::alive() noexcept {
  heard_.store(steady_seconds());
}

std::vector<FollowerRecord> PoseFollower::records() const {
  const auto end = records_.begin() + static_cast<std::ptrdiff_t>(recorded_.load(std::memory_order_acquire));
  return {records_.begin(), end};
}

haptics::SafeWrench PoseFollower::step(const PenSample& sample, double now, double dt) noexcept {
  if (dt == 0) safety_.interrupt();
  if (asked_to_stop_.load()) end(FollowerStop::Asked);
  if (steady_seconds() - heard_.load() > settings_.silence) end(FollowerStop::Silent);
  const bool may_move = state_.load() != FollowerState::Stopped;
  const haptics::ForceState force = safety_.observe({.dt = dt,
                                                     .age = now - sample.time,
                                                     .pose = sample.pose,
                                                     .twist = {sample.velocity, sample.turning},
                                                     .redundancy = sample.stretch,
                                                     .homed = sample.homed,
                                                     .dead_man = may_move,
                                                     .device_fault = sample.fault,
                                                     .device_late = sample.late});
  const bool open = lets_force_through(force);
  if (!may_move) return {};
  // Before the first force the device may still be starting; afterwards a closed gate is a reason to stop.
  if (!open && (opened_ || force == haptics::ForceState::Tripped)) cause_.store(safety_.cause());
  if (!open && opened_) end(FollowerStop::Safety);
  if (!open) return {};
  opened_ = true;
  const bool full = safety_.gain() >= 1;
  if (full) time_ += dt;
  shown_time_.store(time_);
  const Target goal = target();
  if (leads() && astray(sample, goal)) {
    end(FollowerStop::Astray);
    return {};
  }
  const bool moves = full && time_ < keys_.back().time;
  state_.store(!full ? FollowerState::Ramp : moves ? FollowerState::Moving : FollowerState::Holding);
  if (moves) record(sample);
  const PenPosture posture = pen_.posture(pen_.angles(sample.counts));
  last_ = limited(limits_, pushed(capability_, sample.pose.axis), last_, wanted(sample, goal, posture),
                  {sample.velocity, sample.turning}, dt);
  return safety_.release(last_);
}

/// The target at time_.
PoseFollower::Target PoseFollower::target() noexcept {
  while (key_ + 1 < keys_.size() && time_ >= keys_[key_ + 1].time) ++key_;
  const FollowerKey& from = keys_[key_];
  if (key_ + 1 == keys_.size()) return {from.pose, {}, from.extra};
  const FollowerKey& to = keys_[key_ + 1];
  const double length = to.time - from.time, u = (time_ - from.time) / length;
  const double share = u * u * u * (10 + u * (6 * u - 15)), rate = 30 * u * u * (1 - u) * (1 - u) / length;
  const Vec3 chord = to.pose.axis - from.pose.axis, blend = from.pose.axis + share * chord;
  const double size = glm::length(blend);
  Target out{{from.pose.tip + share * (to.pose.tip - from.pose.tip), from.pose.axis},
             {rate * (to.pose.tip - from.pose.tip), Vec3(0)},
             (1 - u) * from.extra + u * to.extra};
  if (size > 0) {  // opposite axes have no direction between them
    out.pose.axis = blend / size;
    out.twist.angular = rate / size * glm::cross(out.pose.axis, chord);
  }
  return out;
}

/// Coupling to the target, and what carries the arms and the hung weight.
Wrench PoseFollower::wanted(const PenSample& sample, const Target& goal, const PenPosture& posture) const noexcept {
  const PenGeometry& g = pen_.geometry();
  Wrench out = goal.extra;
  if (leads())
    out = out + couple(settings_.coupling, haptics::pose_error(sample.pose, goal.pose),
                       {sample.velocity, sample.turning}, goal.twist)
                    .on_device;
  if (settings_.gravity > 0)
    out = out + settings_.gravity * felt_wrench(pen_, posture, gravity_torques(g, posture.angles));
  if (settings_.weight > 0) {
    const Vec3 up = settings_.weight * pen_.from_base(Vec3(0, 0, 1));
    out = out + Wrench{up, glm::cross(-settings_.hook * sample.pose.axis, up)};
  }
  return out;
}

bool PoseFollower::astray(const PenSample& sample, const Target& goal) const noexcept {
  return !(glm::length(sample.pose.tip - goal.pose.tip) <= settings_.astray.linear &&
           geom::angle_between(sample.pose.axis, goal.pose.axis) <= settings_.astray.angular);
}

void PoseFollower::end(FollowerStop reason) noexcept {
  if (state_.load() == FollowerState::Stopped) return;
  reason_.store(reason);
  state_.store(FollowerState::Stopped);
}

void PoseFollower::record(const PenSample& sample) noexcept {
  const std::size_t n = recorded_.load(std::memory_order_relaxed);
  if (n == records_.size() || sample.sequence == sequence_) return;
  sequence_ = sample.sequence;
  records_[n] = {sample.sequence, time_, sample.counts, sample.currents};
  recorded_.store(n + 1, std::memory_order_release);
}

}  // namespace riffler::pen
