#include "nc/subdivider.hpp"

#include <cmath>
#include <limits>

#include "geom/directions.hpp"

namespace riffler {

Joints mix(const Joints& a, const Joints& b, double t) {
  Joints out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = a[k] + t * (b[k] - a[k]);
  return out;
}

double rotary_way(const Joints& a, const Joints& b) {
  return std::abs(b[3] - a[3]) + std::abs(b[4] - a[4]) + std::abs(b[5] - a[5]);
}

/// A stretch of a move: shares t0 to t1 of it and the joints there.
struct Subdivider::Part {
  double t0, t1;
  Joints j0, j1;
};

bool Subdivider::fits(const Motion& motion, const Part& part, bool free) const {
  // Both errors vanish at the ends and are smooth between them: where the largest of nine samples is within 0.8 of the
  // tolerance, so is what lies between the samples within the whole of it.
  constexpr int kSamples = 9;
  for (int i = 1; i <= kSamples; ++i) {
    const double s = i / (kSamples + 1.0), t = part.t0 + s * (part.t1 - part.t0);
    const Pose is = machine_.pose(mix(part.j0, part.j1, s));
    if (glm::length(is.tip - motion.tip(t)) > 0.8 * tolerance_) return false;
    if (!free && angle_between(is.axis, motion.axis(t)) > 0.8 * axis_tolerance_) return false;
  }
  return true;
}

/// Joints at the middle of the part, on the branch that is nearer to the joints' own middle. Close to the pole, closer
/// than the axis need be held, the free axis moves on evenly: this is how a move that passes the pole changes branches.
Joints Subdivider::between(const Motion& motion, const Part& part, bool free) const {
  const Joints near = mix(part.j0, part.j1, 0.5);
  const double t = (part.t0 + part.t1) / 2;
  if (free) return machine_.with_tip(near, motion.tip(t));
  Joints best{};
  double least = std::numeric_limits<double>::infinity();
  for (int b = 0; b < machine_.branches(); ++b) {
    const Joints joints = machine_.joints(motion.at(t), b, near, axis_tolerance_ / 2);
    const double way = rotary_way(near, joints);
    if (way < least) least = way, best = joints;
  }
  return best;
}

const std::vector<Joints>& Subdivider::split(const Pose& a, const Joints& ja, const Pose& b, const Joints& jb,
                                             bool free) {
  // 2^40 parts of one move cannot be told apart in doubles; where the rotary axes are continuous it never comes to
  // that.
  constexpr double kLeast = 0x1p-40;
  out_.clear();
  // What may go any way has no great circle to keep to, and may have opposite ends.
  const Motion motion(a, free ? Pose{b.tip, a.axis} : b);
  // A stack of parts that are still to be done, the earliest on top.
  std::vector<Part> todo{{0, 1, ja, jb}};
  while (!todo.empty()) {
    const Part part = todo.back();
    todo.pop_back();
    if (part.t1 - part.t0 <= kLeast || fits(motion, part, free)) {
      out_.push_back(part.j1);
      continue;
    }
    const double middle = (part.t0 + part.t1) / 2;
    const Joints joints = between(motion, part, free);
    todo.push_back({middle, part.t1, joints, part.j1});
    todo.push_back({part.t0, middle, part.j0, joints});
  }
  return out_;
}

}  // namespace riffler
