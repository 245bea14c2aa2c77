#include "nc/write/subdivider.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/math.hpp"

namespace riffler::nc {

Joints mix(const Joints& a, const Joints& b, double t) {
  Joints out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = a[k] + t * (b[k] - a[k]);
  return out;
}

double rotary_way(const Joints& a, const Joints& b) {
  return std::abs(b[3] - a[3]) + std::abs(b[4] - a[4]) + std::abs(b[5] - a[5]);
}

double nearest_to_pole(const Motion& motion, const Vec3& pole) {
  const auto height = [&](double t) { return std::abs(glm::dot(motion.axis(t), pole)); };
  if (motion.angle() > 0) {
    // The cosine of the angle to the pole varies as cos(angle t − phase), that to its opposite half a turn later.
    const Vec3 &start = motion.from().axis, ahead = glm::cross(motion.rotation() / motion.angle(), start);
    double phase = base::atan2(glm::dot(ahead, pole), glm::dot(start, pole));
    if (phase < 0) phase += kPi;
    if (phase < motion.angle()) return phase / motion.angle();
  }
  return height(0) >= height(1) ? 0 : 1;
}

/// A piece of a move: fractions t0 to t1 of it and the joints there.
struct Subdivider::Part {
  double t0, t1;
  Joints j0, j1;
};

bool Subdivider::fits(const Motion& motion, const Part& part, bool free) const {
  // Both errors vanish at the ends and are smooth in between: if the largest of nine samples is within 0.8 of the
  // tolerance, everything between the samples is within the tolerance.
  constexpr int kSamples = 9;
  // From one sample to the next, whole turns look like standstill.
  constexpr double kMaxTurned = 120;  // deg
  if (machine_.joint_words() && rotary_way(part.j0, part.j1) > kMaxTurned) return false;
  for (int i = 1; i <= kSamples; ++i) {
    const double s = i / (kSamples + 1.0), t = part.t0 + s * (part.t1 - part.t0);
    const Pose is = machine_.pose(mix(part.j0, part.j1, s));
    if (glm::length(is.tip - motion.tip(t)) > 0.8 * tolerance_) return false;
    if (!free && geom::angle_between(is.axis, motion.axis(t)) > 0.8 * axis_tolerance_) return false;
  }
  return true;
}

/// The branches of a move: `first` up to fraction `change`, then `last`.
struct Subdivider::Route {
  int first = 0, last = 0;
  double change = 1;
};

/// The branch on which `joints` hold the pose; −1 if both branches coincide.
int Subdivider::branch_of(const Pose& pose, const Joints& joints) const {
  if (machine_.branches() == 1) return 0;
  constexpr double kOne = 1e-4;  // deg
  const double free = free_angle(axis_tolerance_);
  const Joints zero = machine_.joints(pose, 0, joints, free), one = machine_.joints(pose, 1, joints, free);
  if (rotary_way(zero, one) < kOne) return -1;
  return rotary_way(joints, zero) <= rotary_way(joints, one) ? 0 : 1;
}

/// A move that changes the branch does so at its point nearest to the pole.
Subdivider::Route Subdivider::route(const Motion& motion, const Joints& from, const Joints& to) const {
  const int a = branch_of(motion.from(), from), b = branch_of(motion.to(), to);
  const double change = nearest_to_pole(motion, machine_.pole());
  if (a < 0 || b < 0) return {std::max({a, b, 0}), std::max({a, b, 0}), change};
  return {a, b, change};
}

/// Joints at the middle of the part. If it is closer to the pole than the axis tolerance requires, the free axis moves
/// on evenly: this is how a move that passes the pole changes branches.
Joints Subdivider::between(const Motion& motion, const Part& part, const Route& route) const {
  const double t = (part.t0 + part.t1) / 2, free = axis_tolerance_ / 2;
  const bool before = t < route.change;
  const int branch = before ? route.first : route.last;
  const Pose pose = motion.at(t);
  const Joints near = mix(part.j0, part.j1, 0.5), held = machine_.joints(pose, branch, near, free);
  if (machine_.branches() == 1 || part.t0 >= route.change || part.t1 <= route.change) return held;
  // The free axis turns by less than half a turn on either side of the point nearest to the pole, and by up to a whole
  // turn in total.
  const std::size_t k = machine_.free_joint();
  return held[k] == near[k] ? held : machine_.joints(pose, branch, before ? part.j0 : part.j1, free);
}

const std::vector<Joints>& Subdivider::split(const Pose& a, const Joints& ja, const Pose& b, const Joints& jb,
                                             bool free) {
  // 2^40 parts of one move are indistinguishable in doubles; with continuous rotary axes this is never reached. A
  // discontinuous motion must not become one long block.
  constexpr double kMin = 0x1p-40;
  out_.clear();
  // A free move has no great circle to follow, and its axes may be opposite.
  const Motion motion(a, free ? Pose{b.tip, a.axis} : b);
  // A stack of pending parts, the earliest on top.
  std::vector<Part> todo{{0, 1, ja, jb}};
  std::optional<Route> route;
  while (!todo.empty()) {
    const Part part = todo.back();
    todo.pop_back();
    if (fits(motion, part, free)) {
      out_.push_back(part.j1);
      continue;
    }
    if (part.t1 - part.t0 <= kMin)
      throw std::invalid_argument("the rotary axes of machine " + machine_.name() +
                                  " cannot follow the axis within axis_tolerance");
    const double middle = (part.t0 + part.t1) / 2;
    if (!free && !route) route = this->route(motion, ja, jb);
    const Joints joints =
        free ? machine_.with_tip(mix(part.j0, part.j1, 0.5), motion.tip(middle)) : between(motion, part, *route);
    todo.push_back({middle, part.t1, joints, part.j1});
    todo.push_back({part.t0, middle, part.j0, joints});
  }
  return out_;
}

}  // namespace riffler::nc
