#include "riffler/haptics/sculpt_step.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/functions.hpp"
#include "riffler/base/check.hpp"

namespace riffler::haptics {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kPoints = 4096;  // contact points for which memory is reserved at the start

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Pose moved(const Pose& from, const Twist& way) {
  const double angle = glm::length(way.angular);
  if (angle == 0) return {from.tip + way.linear, from.axis};
  const Vec3 side = glm::cross(way.angular / angle, from.axis);
  return {from.tip + way.linear, glm::normalize(base::cos(angle) * from.axis + base::sin(angle) * side)};
}

/// The displacement between two poses, about `from`'s tip.
Twist way_between(const Pose& from, const Pose& to) {
  const PoseError s = pose_error(to, from);
  return {s.translation, s.rotation};
}

/// Interpolates between two poses of the grip; returns the axis of the later one if the axes are opposite.
Pose between(const Pose& from, const Pose& to, double t) {
  if (t >= 1 || glm::dot(from.axis, to.axis) < -0.99) return {glm::mix(from.tip, to.tip, std::min(t, 1.0)), to.axis};
  return Motion(from, to).at(t);
}

/// Scales a displacement down to the bounds.
Twist within(const Twist& way, const Bounds& most) {
  const auto factor = [](double length, double limit) { return length > limit ? limit / length : 1; };
  return std::min(factor(glm::length(way.linear), most.linear), factor(glm::length(way.angular), most.angular)) * way;
}

bool usable(const Pose& p) {
  return geom::finite(p.tip) && std::abs(glm::length(p.axis) - 1) < 1e-6;
}

Wrench times(const collide::ContactStiffness& k, const Twist& way) {
  Wrench out;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) out[i] += k[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * way[j];
  return out;
}

collide::ContactStiffness scaled(collide::ContactStiffness k, double factor) {
  for (auto& row : k)
    for (double& value : row) value *= factor;
  return k;
}

}  // namespace

SculptSettings SculptSettings::at_tool(double scale) const {
  SculptSettings out = *this;
  out.coupling = coupling.at_tool(scale);
  return out;
}

void SculptSettings::validate() const {
  coupling.validate();
  base::require_positive(coupling.stiffness, "coupling.stiffness");
  base::require_positive(coupling.turn_stiffness, "coupling.turn_stiffness");
  if (memory) base::require_positive(*memory, "memory");
  base::require_not_negative(damping, "damping");
  base::require_between(parts, 1, 64, "parts");
  base::require_between(queries, 1, 64, "queries");
  base::require_positive(touch_stiffness, "touch_stiffness");
  base::require_positive(firmness, "firmness");
  base::require_not_negative(settled, "settled");
  base::require_positive(most.linear, "most.linear");
  base::require_between(most.angular, 0, 1, "most.angular");
  require_positive(rest, "rest");
  base::require_positive(missed, "missed");
  if (budget) base::require_not_negative(*budget, "budget");
}

/// One part of a step.
struct SculptStep::Part {
  Pose grip;     // at the end of the part
  Twist moving;  // of the grip, about its own point
  double dt;
  Bounds most;                   // of the tool's motion
  bool touches;                  // the stock
  std::optional<double> budget;  // s for queries
};

SculptStep::SculptStep(const SculptSettings& settings, const Tool& tool, sweep::MoveCarver* stock,
                       const collide::Collider* obstacles, Guide* guide, const Volume* touched)
    : settings_(settings),
      assembly_(tool),
      cutting_reach_(std::max(tool.length(), 0.5 * tool.diameter())),
      stock_(stock),
      obstacles_(obstacles),
      guide_(guide),
      touched_(touched),
      resistance_((settings.validate(), settings.memory.value_or(stock ? memory_for(stock->pitch()) : 1)),
                  settings.damping) {
  if (touched) stock_contact_.emplace(tool);
  if (!obstacles) return;
  assembly_.deepest();  // computed now rather than in a step
  contact_.points.reserve(kPoints), contact_.touches.reserve(kPoints);
}

void SculptStep::set_coupling(const CouplingSettings& coupling) {
  SculptSettings changed = settings_;
  changed.coupling = coupling;
  changed.validate();
  settings_ = changed;
}

void SculptStep::place(const Pose& pose) {
  tool_ = grip_ = guide_ ? guide_->settled(pose) : pose;
  rate_ = {}, slowing_ = {};
  fresh_ = true, touching_ = felt_ = false, bound_ = sunk_ = 0;
  resistance_.forget();
}

Twist SculptStep::solved(const Balance& balance) const {
  if (!guide_) return balance.solve();
  const Guide::Freedoms f = guide_->freedoms();
  if (f.back == 0 && f.on == 0) return balance.solve(f.turns);
  const std::array<Twist, 3> all{f.turns[0], f.turns[1], f.slide};
  const Twist way = balance.solve(all);
  // The displacement without its turns is the slide. A tool that would leave the curve stops at its end and turns there
  // to balance.
  Vec3 rest = way.linear;
  for (const Twist& turn : f.turns) rest -= glm::dot(way.angular, turn.angular) * turn.linear;
  const double slide = glm::dot(rest, f.slide.linear), most = std::clamp(slide, -f.back, f.on);
  return most == slide ? way : balance.solve(f.turns, most * f.slide);
}

/// The tool's pose after a displacement: the guide is curved, the displacement straight.
Pose SculptStep::reached(const Twist& way) const {
  const Pose to = moved(tool_, way);
  return guide_ ? guide_->settled(to) : to;
}

/// The equilibrium of all known forces, as a displacement of the tool.
Twist SculptStep::balanced(const Part& part) const {
  const CouplingSettings& c = settings_.coupling;
  const PoseError ahead = pose_error(part.grip, tool_);
  // Linearise the spring at this stretch: where its force is limited, it is softer.
  const CouplingWrenches pull = couple(c, ahead, {}, {});
  const auto stiffness = [](double force, double length, double small) { return length > 0 ? force / length : small; };
  const Twist far{ahead.translation, ahead.rotation};
  Balance balance(tool_.axis, part.dt);
  balance.add_spring(stiffness(glm::length(pull.on_tool.force), glm::length(far.linear), c.stiffness),
                     stiffness(glm::length(pull.on_tool.torque), glm::length(far.angular), c.turn_stiffness), far);
  balance.add_damper({ahead.translation, c.damping, c.turn_damping}, part.moving);
  balance.add_damper(resistance_.damper());
  Twist way = solved(balance);
  if (touching_) {
    const Wrench contact = settings_.firmness * Wrench{contact_.force, contact_.torque};
    const collide::ContactStiffness stiffness_there = scaled(contact_.stiffness, settings_.firmness);
    const Twist from_asked = way_between(tool_, asked_);
    balance.add_contact(contact + times(stiffness_there, from_asked), stiffness_there);
    balance.add_contact({}, scaled(slowing_, settings_.firmness));
    const Twist kept = solved(balance);
    // Contacts push but do not pull. When the hand lifts the tool off, the tool goes only to where the contact force
    // ends, unless it is free there.
    const auto push = [&](const Twist& w) {
      return glm::dot((contact - times(stiffness_there, w - from_asked)).force, contact.force);
    };
    const double held = push(kept), off = push(way);
    if (held >= 0)
      way = kept;
    else if (off > 0)
      way = kept - held / (held - off) * (kept - way);
  }
  return way;
}

/// Queries the obstacles. False if the query leaves too large a depth unchecked.
bool SculptStep::look_at_obstacles(const Part& part) {
  if (!obstacles_) {
    contact_.force = contact_.torque = Vec3(0), contact_.stiffness = {};
    return true;
  }
  obstacles_->query(assembly_, asked_, part.budget, contact_, 0.1 * settings_.missed);
  return contact_.missed_depth_bound <= settings_.missed;
}

/// Adds the contact with the stock. False if the tool is too deep in it to be queried.
bool SculptStep::look_at_stock() {
  const auto overlap = stock_contact_->add(*touched_, asked_, settings_.touch_stiffness, contact_);
  sunk_ = overlap.depth();
  // The next step without cutting decides again whether the stock is felt; until then the tool passes through it.
  if (!overlap.complete) felt_ = false;
  return overlap.complete;
}

/// Prepares a step without cutting: the stock is felt unless the tool is already deep in it. Columns are as wide as
/// their cells, so they overhang into the tool that has just cut them, by an eighth of the pitch on average.
void SculptStep::begin_touch() {
  if (felt_) return;
  const auto overlap = stock_contact_->add(*touched_, tool_, 0, contact_);
  felt_ = overlap.complete && overlap.depth() <= 0.3 * touched_->frame().pitch;
}

/// Prepares a step that cuts: the stock is not felt.
void SculptStep::end_touch() {
  if (sunk_ > 0) touching_ = false, slowing_ = {};
  felt_ = false, sunk_ = 0;
}

/// Queries the contact at the end of a displacement. False if the query leaves too large a depth unchecked.
bool SculptStep::look(const Twist& way, const Part& part, Result& result) {
  asked_ = reached(way);
  const bool known = look_at_obstacles(part), out = !part.touches || look_at_stock();
  touching_ = contact_.depth > 0 || sunk_ > 0;
  result.touching |= sunk_ > 0, result.held |= !known;
  // The pushing direction need not be the tool's normal, which makes a stiff contact oscillate. Adding the recent
  // resistance as damping along the same directions stops that.
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      slowing_[i][j] = touching_ ? 0.75 * slowing_[i][j] + 0.25 * contact_.stiffness[i][j] : 0;
  ++result.queries;
  return known && out;
}

Twist SculptStep::advance(const Part& part, Result& result) {
  Twist way = within(balanced(part), part.most);
  if (!obstacles_ && !part.touches) return way;
  const auto size = [&](const Twist& w) { return glm::length(w.linear) + glm::length(w.angular) * assembly_.reach(); };
  for (int k = 0; k < settings_.queries; ++k) {
    if (!look(way, part, result)) {
      touching_ = false, sunk_ = 0;
      return {};
    }
    const Twist before = way;
    if (touching_) {
      // Bound the motion from the queried pose by the same distance again plus the depth found there. On a guide a
      // light touch may leave the tool free to move far; without another query it moves no farther than that free
      // distance.
      const double depth = contact_.depth + sunk_;
      Bounds most{part.most.linear + depth, part.most.angular + depth / assembly_.max_radius()};
      if (guide_ && k + 1 == settings_.queries) {
        const double room = settings_.missed + contact_.depth;
        most = {std::min(most.linear, room), std::min(most.angular, room / assembly_.reach())};
      }
      way = before + within(balanced(part) - before, most);
    }
    const double change = size(way - before);
    // Distances change by at most the displacement of the tool's points.
    if (obstacles_) bound_ = contact_.depth + contact_.missed_depth_bound + change;
    if (change <= settings_.settled) break;
  }
  return way;
}

void SculptStep::cut(const Pose& to, const Twist& way, double dt, Result& result) {
  // Also reset for a tool at rest: otherwise, after a slow cut that left no time for queries, it would stay held.
  cut_seconds_ = 0;
  // A tool at rest has already cut there; a journal replays only poses that differ.
  if (!stock_ || (to.tip == tool_.tip && to.axis == tool_.axis)) return;
  const Clock::time_point start = Clock::now();
  const sweep::MoveCarver::Taken taken = stock_->move(tool_, to, dt);
  if (settings_.budget) cut_seconds_ = seconds_since(start);
  ++result.cuts;
  result.removed += taken.removed;
  if (!fresh_) {
    result.on_tool = {taken.force, taken.torque};
    resistance_.learn(way, result.on_tool, dt, cutting_reach_);
  }
  fresh_ = false;
}

/// Bounds the motion so that a released tool does not fly off: at most twice the grip's motion plus twice the tool's
/// own last motion. Whatever it moves into is then queried in time.
Bounds SculptStep::most_of(const Pose& grip, double share, double dt) const {
  const Twist hand = way_between(grip_, grip), own = dt * rate_;
  const auto bound = [&](const Vec3& a, const Vec3& b, double rest, double most) {
    return share * std::min(most, 2 * glm::length(a) + 2 * glm::length(b) + rest);
  };
  return {bound(hand.linear, own.linear, settings_.rest.linear, settings_.most.linear),
          bound(hand.angular, own.angular, settings_.rest.angular, settings_.most.angular)};
}

SculptStep::Result SculptStep::step(const Pose& grip, const Twist& twist, double dt, bool cutting) {
  Result result;
  result.tool = tool_, result.depth_bound = bound_;
  if (!usable(grip) || !finite(twist) || !(dt > 0) || !std::isfinite(dt)) return result;
  const Clock::time_point start = Clock::now();
  const Pose last = grip_;
  if (touched_) cutting ? end_touch() : begin_touch();
  double gone = 0;
  for (int parts = settings_.parts, k = 1; k <= parts; ++k) {
    const double share = (1 - gone) / (parts - k + 1);
    Part part{between(last, grip, gone + share), twist, share * dt, most_of(grip, share, dt), touched_ && felt_, {}};
    if (settings_.budget) {
      const double left = *settings_.budget - seconds_since(start) - cut_seconds_;
      part.budget = std::max(0.0, left / settings_.queries);
    }
    Twist way = advance(part, result);
    const Pose to = reached(way);
    if (guide_) way = way_between(tool_, to);
    if (cutting)
      cut(to, way, part.dt, result);
    else
      fresh_ = true, resistance_.forget();
    tool_ = to, rate_ = 1 / part.dt * way, gone += share;
    const double each = seconds_since(start) / k;
    if (settings_.budget && k < parts - 1 && seconds_since(start) + 2 * each > *settings_.budget)
      parts = k + 1, result.shortened = true;  // do the rest in one part
  }
  grip_ = grip;
  const PoseError ahead = pose_error(grip, tool_);
  const Twist at_grip{rate_.linear + glm::cross(rate_.angular, ahead.translation), rate_.angular};
  result.on_grip = couple(settings_.coupling, ahead, twist, at_grip).on_device;
  result.tool = tool_, result.depth_bound = bound_;
  return result;
}

}  // namespace riffler::haptics
