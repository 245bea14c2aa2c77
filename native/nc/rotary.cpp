#include "nc/rotary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>

#include "geom/directions.hpp"

namespace riffler {

namespace {

/// Angle to the pole or to its opposite, whichever is nearer.
double pole_angle(const Vec3& axis, const Vec3& pole) {
  return std::atan2(glm::length(glm::cross(axis, pole)), std::abs(glm::dot(axis, pole)));
}

/// The least pole_angle on the great arc from a to b.
double arc_pole_angle(const Vec3& a, const Vec3& b, const Vec3& pole) {
  const double ends = std::min(pole_angle(a, pole), pole_angle(b, pole));
  const Vec3 cross = glm::cross(a, b);
  const double sine = glm::length(cross);
  if (sine == 0) return ends;
  const Vec3 normal = cross / sine;
  const double off = std::abs(glm::dot(pole, normal));
  if (off >= 1) return ends;
  // The circle's nearest point to the pole; it counts where it lies on the arc (for the pole or for its opposite).
  const Vec3 foot = pole - glm::dot(pole, normal) * normal;
  const double after_a = glm::dot(glm::cross(a, foot), normal), before_b = glm::dot(glm::cross(foot, b), normal);
  const bool on_arc = (after_a >= 0 && before_b >= 0) || (after_a <= 0 && before_b <= 0);
  return on_arc ? std::min(ends, std::asin(off)) : ends;
}

double rotary_way(const Joints& a, const Joints& b) {
  return std::abs(b[3] - a[3]) + std::abs(b[4] - a[4]) + std::abs(b[5] - a[5]);
}

Joints mix(const Joints& a, const Joints& b, double t) {
  Joints out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = a[k] + t * (b[k] - a[k]);
  return out;
}

/// Machine::joints with the row in its message.
Joints joints_of_row(const Program& program, std::size_t row, const Machine& machine, int branch, const Joints& near) {
  try {
    return machine.joints(program.poses()[row], branch, near, kFreeAngle);
  } catch (const std::invalid_argument& e) {
    throw std::invalid_argument("poses, row " + std::to_string(row) + ": " + e.what());
  }
}

constexpr std::size_t kMaxBranches = 2;

struct State {
  double cost = 0;
  Joints joints{};
};

using States = std::array<State, kMaxBranches>;

/// Where the axes stand before the first row: a free axis as the first row that needs it will have it. A tie goes to
/// branch 0 whatever the rounding: its head start is the least step that is printed.
States start_states(const Program& program, const Machine& machine) {
  States states;
  const auto away = std::find_if(program.poses().begin(), program.poses().end(),
                                 [&](const Pose& pose) { return pole_angle(pose.axis, machine.pole()) > kFreeAngle; });
  for (int b = 0; b < machine.branches(); ++b) {
    State& state = states[static_cast<std::size_t>(b)];
    state.cost = 1e-6 * b;
    if (away != program.poses().end())
      state.joints = joints_of_row(program, static_cast<std::size_t>(away - program.poses().begin()), machine, b, {});
  }
  return states;
}

}  // namespace

std::vector<Joints> choose_joints(const Program& program, const Machine& machine, double axis_tolerance) {
  const std::size_t n = program.size();
  const int branches = machine.branches();
  const Vec3 pole = machine.pole();
  const States start = start_states(program, machine);
  // came_from[row][b]: the branch of the row before on the shortest way to branch b of this row.
  std::vector<std::array<std::uint8_t, kMaxBranches>> came_from(n);
  States states = start;
  for (std::size_t row = 0; row < n; ++row) {
    bool may_change = row > 0 && branches > 1;
    if (row > 0 && !program.rapid()[row]) {
      const Vec3 &a = program.poses()[row - 1].axis, &b = program.poses()[row].axis;
      if (angle_between(a, b) > std::numbers::pi - 1e-9)
        throw std::invalid_argument("poses, row " + std::to_string(row) +
                                    ": the axis is opposite to that of the row before");
      may_change = may_change && arc_pole_angle(a, b, pole) <= axis_tolerance / 4;
    }
    States next;
    for (int b = 0; b < branches; ++b) {
      State& to = next[static_cast<std::size_t>(b)];
      to.cost = std::numeric_limits<double>::infinity();
      for (int from = 0; from < branches; ++from) {
        if (from != b && !may_change) continue;
        const State& before = states[static_cast<std::size_t>(from)];
        const Joints joints = joints_of_row(program, row, machine, b, before.joints);
        const double cost = before.cost + (row > 0 ? rotary_way(before.joints, joints) : 0);
        if (cost < to.cost) {
          to = {cost, joints};
          came_from[row][static_cast<std::size_t>(b)] = static_cast<std::uint8_t>(from);
        }
      }
    }
    states = next;
  }

  std::vector<std::uint8_t> branch(n);
  std::uint8_t b = branches > 1 && states[1].cost < states[0].cost;
  for (std::size_t row = n; row-- > 0; b = came_from[row][b]) branch[row] = b;
  std::vector<Joints> out(n);
  for (std::size_t row = 0; row < n; ++row)
    out[row] = joints_of_row(program, row, machine, branch[row], row > 0 ? out[row - 1] : start[branch[0]].joints);
  return out;
}

/// A stretch of a move: shares t0 to t1 of it and the joints there.
struct Subdivider::Part {
  double t0, t1;
  Joints j0, j1;
};

bool Subdivider::fits(const Motion& motion, const Part& part, bool rapid) const {
  // Both errors vanish at the ends and are smooth between them: where the largest of nine samples is within 0.8 of the
  // tolerance, so is what lies between the samples within the whole of it.
  constexpr int kSamples = 9;
  for (int i = 1; i <= kSamples; ++i) {
    const double s = i / (kSamples + 1.0), t = part.t0 + s * (part.t1 - part.t0);
    const Pose is = machine_.pose(mix(part.j0, part.j1, s)), wanted = motion.at(t);
    if (glm::length(is.tip - wanted.tip) > 0.8 * tolerance_) return false;
    if (!rapid && angle_between(is.axis, wanted.axis) > 0.8 * axis_tolerance_) return false;
  }
  return true;
}

/// Joints at the middle of the part, on the branch that is nearer to the joints' own middle. Close to the pole, closer
/// than the axis need be held, the free axis moves on evenly: this is how a move that passes the pole changes branches.
Joints Subdivider::between(const Motion& motion, const Part& part) const {
  const Joints near = mix(part.j0, part.j1, 0.5);
  const Pose pose = motion.at((part.t0 + part.t1) / 2);
  Joints best{};
  double least = std::numeric_limits<double>::infinity();
  for (int b = 0; b < machine_.branches(); ++b) {
    const Joints joints = machine_.joints(pose, b, near, axis_tolerance_ / 2);
    const double way = rotary_way(near, joints);
    if (way < least) least = way, best = joints;
  }
  return best;
}

const std::vector<Joints>& Subdivider::split(const Pose& a, const Joints& ja, const Pose& b, const Joints& jb,
                                             bool rapid) {
  // 2^40 parts of one move cannot be told apart in doubles; where the rotary axes are continuous it never comes to
  // that.
  constexpr double kLeast = 0x1p-40;
  out_.clear();
  const Motion motion(a, b);
  // A stack of parts that are still to be done, the earliest on top.
  std::vector<Part> todo{{0, 1, ja, jb}};
  while (!todo.empty()) {
    const Part part = todo.back();
    todo.pop_back();
    if (part.t1 - part.t0 <= kLeast || fits(motion, part, rapid)) {
      out_.push_back(part.j1);
      continue;
    }
    const double middle = (part.t0 + part.t1) / 2;
    const Joints joints = between(motion, part);
    todo.push_back({middle, part.t1, joints, part.j1});
    todo.push_back({part.t0, middle, part.j0, joints});
  }
  return out_;
}

}  // namespace riffler
