#include "riffler/session/orient_session.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/own_thread.hpp"
#include "riffler/base/check.hpp"
#include "riffler/plan/cc_frame.hpp"
#include "session/step_thread.hpp"

namespace riffler::session {

namespace {

Vec3 first_axis(const plan::PencilPath& path, const OrientSessionSettings& settings) {
  if (settings.axis) return plan::unit_axis(*settings.axis, "axis");
  if (settings.point >= path.size()) return {0, 0, 1};  // PathGuide reports it
  return path.axes.empty() ? plan::bisector_at(path, settings.point) : path.axes[settings.point];
}

/// mm along the path from its first point to each point, and, if it is closed, back to the first.
std::vector<double> lengths_of(const plan::PencilPath& path) {
  std::vector<double> out{0};
  const std::size_t n = path.size(), edges = path.closed ? n : n - 1;
  for (std::size_t k = 0; k < edges; ++k)
    out.push_back(out.back() + glm::length(path.centres[(k + 1) % n] - path.centres[k]));
  return out;
}

}  // namespace

void OrientSessionSettings::validate() const {
  loop.validate();
  base::require_not_negative(reach, "reach");
}

struct OrientSession::Core {
  Core(const plan::PencilPath& path, const Tool& tool, std::shared_ptr<pen::Pen> pen,
       std::shared_ptr<const collide::Collider> obstacles, const OrientSessionSettings& settings);
  ~Core();

  enum class State : unsigned char { New, Running, Ended };
  OrientFrame taken();
  KeyChange apply(const KeyPress& press);
  std::optional<std::size_t> key_near(double station) const;
  double length_at(double station) const;
  void set_keys(const plan::OrientationKeys& keys);

  OrientSessionSettings settings_;
  plan::PencilPath given_, path_;
  plan::OrientationKeys keys_;
  std::vector<double> lengths_;
  std::shared_ptr<pen::Pen> pen_;
  std::shared_ptr<const collide::Collider> obstacles_;
  std::shared_ptr<OrientLoop> loop_;
  StepThread ticks_;
  base::HomeProcess home_;
  State state_ = State::New;
};

OrientSession::Core::Core(const plan::PencilPath& path, const Tool& tool, std::shared_ptr<pen::Pen> pen,
                          std::shared_ptr<const collide::Collider> obstacles, const OrientSessionSettings& settings)
    : settings_((settings.validate(), settings)),
      given_(path),
      path_(path),
      pen_(std::move(pen)),
      obstacles_(std::move(obstacles)) {
  if (!pen_) throw std::invalid_argument("a session needs a device");
  if (!obstacles_) throw std::invalid_argument("a session needs a part: its collider");
  const PathGuide guide(path, tool, settings.point, first_axis(path, settings), settings.loop.slides);
  lengths_ = lengths_of(path);
  set_keys({path.keys.begin(), path.keys.end()});
  settings_.loop.safety = for_device(settings_.loop.safety, pen_->capability());
  loop_ =
      std::make_shared<OrientLoop>(settings_.loop, tool, guide, *obstacles_, pen_->capability(), pen_->in_part_frame());
}

OrientSession::Core::~Core() {
  if (!home_.here()) {  // after a fork, the missing thread may hold the locks
    static_cast<void>(new std::shared_ptr<OrientLoop>(std::move(loop_)));
    static_cast<void>(new std::shared_ptr<pen::Pen>(std::move(pen_)));
    return;
  }
  if (state_ == State::Running) ticks_.stop(*pen_, *loop_, settings_.loop.safety.fall);
}

void OrientSession::Core::set_keys(const plan::OrientationKeys& keys) {
  plan::PencilPath path =
      keys.empty() ? given_ : plan::oriented(given_, keys, settings_.interpolation, settings_.limit);
  if (keys.empty()) path.keys.clear();
  path_ = std::move(path), keys_ = keys;
}

double OrientSession::Core::length_at(double station) const {
  const auto k = static_cast<std::size_t>(station);
  if (k + 1 >= lengths_.size()) return lengths_.back();
  return std::lerp(lengths_[k], lengths_[k + 1], station - std::floor(station));
}

/// The key nearest to a place, if one is within reach.
std::optional<std::size_t> OrientSession::Core::key_near(double station) const {
  std::optional<std::size_t> best;
  double closest = settings_.reach;
  for (const auto& [point, axis] : keys_) {
    double away = std::abs(lengths_[point] - length_at(station));
    if (given_.closed) away = std::min(away, lengths_.back() - away);
    if (away <= closest) best = point, closest = away;
  }
  return best;
}

KeyChange OrientSession::Core::apply(const KeyPress& press) {
  const auto here = static_cast<std::size_t>(std::lround(press.station)) % given_.size();
  KeyChange change{press.time, here, press.axis, press.deletes, ""};
  plan::OrientationKeys keys = keys_;
  if (press.deletes) {
    const std::optional<std::size_t> found = key_near(press.station);
    if (!found) {
      change.refused = "there is no key here to delete";
      return change;
    }
    change.point = *found, change.axis = keys.at(*found);
    keys.erase(*found);
  } else {
    keys[here] = press.axis;
  }
  try {
    set_keys(keys);
  } catch (const std::invalid_argument& error) {
    change.refused = error.what();
  }
  return change;
}

OrientFrame OrientSession::Core::taken() {
  OrientFrame frame;
  for (OrientTick tick; loop_->take(tick);) frame.ticks.push_back(tick);
  for (KeyPress press; loop_->take(press);) frame.changes.push_back(apply(press));
  frame.dropped_ticks = loop_->dropped_ticks(), frame.dropped_presses = loop_->dropped_presses();
  return frame;
}

OrientSession::OrientSession(const plan::PencilPath& path, const Tool& tool, std::shared_ptr<pen::Pen> pen,
                             std::shared_ptr<const collide::Collider> obstacles, const OrientSessionSettings& settings)
    : core_(std::make_unique<Core>(path, tool, std::move(pen), std::move(obstacles), settings)) {}

OrientSession::~OrientSession() = default;

void OrientSession::start() {
  if (core_->state_ != Core::State::New) throw std::runtime_error("a session runs once: make another");
  core_->ticks_.start(*core_->pen_, core_->loop_);
  core_->state_ = Core::State::Running;
}

bool OrientSession::running() const noexcept {
  return core_->state_ == Core::State::Running;
}

base::ThreadPriority OrientSession::priority() const {
  return core_->ticks_.priority(*core_->pen_);
}

OrientFrame OrientSession::stop() {
  if (running()) {
    core_->home_.check("the session");
    core_->ticks_.stop(*core_->pen_, *core_->loop_, core_->settings_.loop.safety.fall);
    core_->state_ = Core::State::Ended;
  }
  return core_->taken();
}

OrientFrame OrientSession::frame() {
  if (!running()) throw std::runtime_error("the session is not running");
  core_->home_.check("the session");
  return core_->taken();
}

const plan::OrientationKeys& OrientSession::keys() const noexcept {
  return core_->keys_;
}

void OrientSession::set_keys(const plan::OrientationKeys& keys) {
  core_->set_keys(keys);
}

const plan::PencilPath& OrientSession::path() const noexcept {
  return core_->path_;
}

OrientLoop& OrientSession::loop() noexcept {
  return *core_->loop_;
}

pen::Pen& OrientSession::pen() noexcept {
  return *core_->pen_;
}

}  // namespace riffler::session
