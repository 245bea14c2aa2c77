#include "nc/write/rotary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/math.hpp"
#include "nc/number_text.hpp"
#include "nc/write/subdivider.hpp"

namespace riffler::nc {

namespace {

/// mm and deg by which a limit may seem to be exceeded due to rounding.
constexpr double kSlack = 1e-9;

/// Angle to the pole or its opposite, the smaller of both.
double pole_angle(const Vec3& axis, const Vec3& pole) {
  return base::atan2(glm::length(glm::cross(axis, pole)), std::abs(glm::dot(axis, pole)));
}

/// Smallest pole_angle on the great arc from a to b.
double arc_pole_angle(const Vec3& a, const Vec3& b, const Vec3& pole) {
  const double ends = std::min(pole_angle(a, pole), pole_angle(b, pole));
  const Vec3 cross = glm::cross(a, b);
  const double sine = glm::length(cross);
  if (sine == 0) return ends;
  const Vec3 normal = cross / sine;
  const double off = std::abs(glm::dot(pole, normal));
  if (off >= 1) return ends;
  // The circle's point nearest to the pole; it counts if it lies on the arc (for the pole or its opposite).
  const Vec3 foot = pole - glm::dot(pole, normal) * normal;
  const double after_a = glm::dot(glm::cross(a, foot), normal), before_b = glm::dot(glm::cross(foot, b), normal);
  const bool on_arc = (after_a >= 0 && before_b >= 0) || (after_a <= 0 && before_b <= 0);
  return on_arc ? std::min(ends, base::asin(off)) : ends;
}

bool opposite(const Pose& a, const Pose& b) {
  return geom::angle_between(a.axis, b.axis) > kPi - 1e-9;
}

/// A choice of joints at a node, with the best path that leads to it.
struct Stand {
  Joints joints{};
  double way = 0;          // deg: path of all rotary axes
  std::uint32_t from = 0;  // index among the previous node's stands
  std::uint16_t rewinds = 0;
  std::uint8_t branch = 0;

  bool better(const Stand& other) const { return rewinds != other.rewinds ? rewinds < other.rewinds : way < other.way; }
};

using Stands = std::vector<Stand>;

/// What is kept of a stand when the next node is reached.
struct Trace {
  double first, second;  // deg, rotary axes in the order of their letters
  std::uint32_t from;
  std::uint8_t branch;
};

class Chooser {
 public:
  Chooser(const Program& program, const Machine& machine, double axis_tolerance, const std::vector<bool>& free)
      : program_(program), machine_(machine), axis_tolerance_(axis_tolerance), free_(free) {
    for (const char letter : machine.axes().substr(3)) rotary_.push_back(joint_index(letter));
  }

  std::vector<Waypoint> run() {
    if (program_.empty()) return {};
    keep({0, 1, false}, start());
    for (std::size_t row = 1; row < program_.size(); ++row) {
      if (free_[row])
        keep({row, 1, false}, freely(row));
      else
        follow(row);
    }
    return traced();
  }

 private:
  struct Node {
    std::size_t row;
    double share;
    bool rewound;
    std::size_t begin = 0;  // first of its stands in traces_
  };

  const Pose& pose(std::size_t row) const { return program_.poses()[row]; }

  Joints joints_of(std::size_t row, const Pose& pose, int branch, const Joints& near) const {
    try {
      return machine_.joints(pose, branch, near, free_angle(axis_tolerance_));
    } catch (const std::invalid_argument& e) {
      throw RowError("poses", row, e.what());
    }
  }

  bool within(const Joints& joints) const { return machine_.beyond(joints, kSlack) == joints.size(); }

  /// Adds a stand unless one as good exists at the same place.
  void add(Stands& stands, const Stand& stand) const {
    constexpr double kSame = 1e-6;  // deg: smallest printed step
    // Without limits, one place per branch suffices: the shorter path so far stays shorter.
    const bool limits = !machine_.limited().empty();
    for (Stand& other : stands) {
      if (other.branch != stand.branch || (limits && rotary_way(other.joints, stand.joints) > kSame)) continue;
      if (stand.better(other)) other = stand;
      return;
    }
    stands.push_back(stand);
  }

  /// Every allowed place of the rotary axes at this pose: on every branch, for a limited axis the lowest, the highest
  /// and the nearest turn.
  void add_places(Stands& stands, std::size_t row, const Pose& pose, const Stand& from) const {
    for (int b = 0; b < machine_.branches(); ++b) {
      const Joints principal = joints_of(row, pose, b, from.joints);
      std::vector<Joints> all{principal};
      for (const std::size_t k : rotary_) {
        if (!machine_.range(k).limited()) continue;
        std::vector<Joints> more;
        for (const Joints& joints : all)
          for (const double angle : turns_within(machine_.range(k), joints[k])) {
            more.push_back(joints);
            more.back()[k] = angle;
          }
        all = std::move(more);
      }
      for (const Joints& place : all) {
        Stand stand = from;
        stand.joints = machine_.with_tip(place, pose.tip), stand.branch = static_cast<std::uint8_t>(b);
        stand.way += rotary_way(from.joints, stand.joints);
        if (within(stand.joints)) add(stands, stand);
      }
    }
  }

  /// The turns of `angle` within the range: the nearest, the outermost, and those around the nearest.
  static std::vector<double> turns_within(const AxisRange& range, double angle) {
    constexpr int kAround = 8;  // in both directions: all turns in a range of up to 3240°
    std::vector<double> out;
    const auto put = [&](double a) {
      if (a < range.low - kSlack || a > range.high + kSlack) return;
      a = std::clamp(a, range.low, range.high);
      if (std::find(out.begin(), out.end(), a) == out.end()) out.push_back(a);
    };
    const double low = angle + 360 * std::ceil((range.low - kSlack - angle) / 360);
    const double high = angle + 360 * std::floor((range.high + kSlack - angle) / 360);
    const double nearest = std::clamp(angle, low, std::max(low, high));
    put(nearest), put(low), put(high);
    for (int k = 1; k <= kAround; ++k) put(nearest - 360.0 * k), put(nearest + 360.0 * k);
    return out;
  }

  /// The stands before the first row: a free axis takes the value that the first row needing it will have. Ties go to
  /// branch 0 and to the turn nearest to 0, independent of rounding: their advantage is the smallest printed step.
  Stands start() const {
    const auto away = std::find_if(program_.poses().begin(), program_.poses().end(), [&](const Pose& p) {
      return pole_angle(p.axis, machine_.pole()) > free_angle(axis_tolerance_);
    });
    Stands stands;
    for (int b = 0; b < machine_.branches(); ++b) {
      Stand before;
      // An axis that is always free stays within its limits instead of at 0.
      for (const std::size_t k : rotary_)
        before.joints[k] = std::clamp(0.0, machine_.range(k).low, machine_.range(k).high);
      if (away != program_.poses().end())
        before.joints = joints_of(static_cast<std::size_t>(away - program_.poses().begin()), *away, b, {});
      Stands here;
      add_places(here, 0, pose(0), before);
      for (Stand& stand : here) {
        if (stand.branch != b) continue;
        stand.way = 1e-6 * b + 1e-9 * rotary_way({}, stand.joints);
        add(stands, stand);
      }
    }
    if (stands.empty()) refuse(0, pose(0));
    return stands;
  }

  Stands freely(std::size_t row) const {
    Stands next;
    for (std::uint32_t k = 0; k < stands_.size(); ++k) {
      Stand from = stands_[k];
      from.from = k;
      add_places(next, row, pose(row), from);
    }
    if (next.empty()) refuse(row, pose(row));
    return next;
  }

  /// Along the great circle, with as many retracts to unwind axes as the limits require.
  void follow(std::size_t row) {
    const Pose &a = pose(row - 1), &b = pose(row);
    if (opposite(a, b)) throw RowError("poses", row, "the axis is opposite to that of the row before");
    const auto passes_pole = [&](const Vec3& from) {
      return machine_.branches() > 1 && arc_pole_angle(from, b.axis, machine_.pole()) <= axis_tolerance_ / 4;
    };
    bool dead = false;
    Stands next = tied(row, a, b, stands_, passes_pole(a.axis), &dead);
    if (!dead) return keep({row, 1, false}, std::move(next));
    // Some stand reaches a limit: check what unwinding first would gain.
    const Motion motion(a, b);
    double share = 0;
    for (int round = 0;; ++round) {
      Stands turned = rewound(row, motion.at(share));
      Stands after = tied(row, motion.at(share), b, turned, passes_pole(motion.axis(share)), nullptr);
      if (!next.empty() || !after.empty()) {
        if (after.empty() || (!next.empty() && !gains(after, next))) return keep({row, 1, false}, std::move(next));
        keep({share > 0 ? row : row - 1, share > 0 ? share : 1, true}, std::move(turned));
        return keep({row, 1, false}, std::move(after));
      }
      const double reached = reach(row, motion, share, turned);
      if (!(reached > share + 1e-9) || round > 64) refuse(row, motion.at(std::min(1.0, share + 1e-6)));
      keep({share > 0 ? row : row - 1, share > 0 ? share : 1, true}, std::move(turned));
      Stands stop = tied(row, motion.at(share), motion.at(reached), stands_, false, nullptr);
      share = reached;
      keep({row, share, false}, std::move(stop));
      next = tied(row, motion.at(share), b, stands_, passes_pole(motion.axis(share)), nullptr);
    }
  }

  /// Whether some stand in `after` has a place that none in `next` has: unwinding costs more than any path and is
  /// useful only for a place that cannot be reached otherwise.
  bool gains(const Stands& after, const Stands& next) const {
    return std::any_of(after.begin(), after.end(), [&](const Stand& a) {
      return std::none_of(next.begin(), next.end(), [&](const Stand& n) {
        return n.branch == a.branch && rotary_way(n.joints, a.joints) <= 1e-6;
      });
    });
  }

  /// Joints at `to` on `branch`, at the turn that `before` reaches along the great circle.
  Joints followed(std::size_t row, const Pose& from, const Pose& to, const Stand& before, int branch) const {
    const Joints nearest = joints_of(row, to, branch, before.joints);
    if (machine_.branches() == 1) return nearest;
    // Near the pole, the free axis turns by less than half a turn up to the point nearest to the pole, and again after
    // it, but possibly by more in total: as far as the tool turns, plus a quarter turn if the other axis leans.
    const std::size_t k = machine_.free_joint();
    if (std::abs(nearest[k] - before.joints[k]) <= 90) return nearest;
    const Motion motion(from, to);
    const double share = nearest_to_pole(motion, machine_.pole());
    if (share == 0 || share == 1) return nearest;
    return joints_of(row, to, branch, joints_of(row, motion.at(share), before.branch, before.joints));
  }

  struct Step {
    Joints from, to;
  };

  /// The result of the same step from joints that differ by whole turns.
  std::optional<Joints> by_whole_turns(const Step& step, const Joints& from) const {
    Joints out = step.to;
    for (const std::size_t k : rotary_) {
      const double turns = std::round((from[k] - step.from[k]) / 360);
      if (std::abs(from[k] - step.from[k] - 360 * turns) > kSlack) return {};
      out[k] = step.to[k] == step.from[k] ? from[k] : step.to[k] + 360 * turns;
    }
    return out;
  }

  /// From `before` along the great circle to `to`. `passes_pole`: the branch may change, and the free axis may turn in
  /// either direction. `dead`: set if one of them cannot continue.
  Stands tied(std::size_t row, const Pose& from, const Pose& to, const Stands& before, bool passes_pole,
              bool* dead) const {
    constexpr double kMax = 270;  // deg: of the free axis at the pole
    Stands next;
    std::array<std::optional<Step>, 2> steps;  // per branch of the previous stands, without a change of branch
    for (std::uint32_t k = 0; k < before.size(); ++k) {
      bool goes = false;
      for (int b = 0; b < machine_.branches(); ++b) {
        if (b != before[k].branch && !passes_pole) continue;
        auto& step = steps[static_cast<std::size_t>(b)];
        const bool stays = b == before[k].branch;
        const auto shifted = stays && step ? by_whole_turns(*step, before[k].joints) : std::nullopt;
        const Joints nearest = shifted ? *shifted : followed(row, from, to, before[k], b);
        if (stays && !shifted) step = Step{before[k].joints, nearest};
        for (const double turn : {0, -360, 360}) {
          Stand stand = before[k];
          stand.from = k, stand.branch = static_cast<std::uint8_t>(b), stand.joints = nearest;
          if (turn != 0) {
            if (!passes_pole || !machine_.range(machine_.free_joint()).limited()) break;
            const std::size_t j = machine_.free_joint();
            stand.joints[j] += turn;
            if (std::abs(stand.joints[j] - before[k].joints[j]) > kMax) continue;
            stand.joints = machine_.with_tip(stand.joints, to.tip);
          }
          if (!within(stand.joints)) continue;
          stand.way += rotary_way(before[k].joints, stand.joints);
          add(next, stand), goes = true;
        }
      }
      if (!goes && dead) *dead = true;
    }
    return next;
  }

  /// The stands of the previous node, and all that they can become by unwinding.
  Stands rewound(std::size_t row, const Pose& pose) const {
    Stands out;
    for (std::uint32_t k = 0; k < stands_.size(); ++k) {
      Stand stay = stands_[k];
      stay.from = k;
      add(out, stay);
      Stand leave = stay;
      ++leave.rewinds;
      add_places(out, row, pose, leave);
    }
    return out;
  }

  /// The largest fraction of the move at which one of the stands is still within the limits.
  double reach(std::size_t row, const Motion& motion, double from, const Stands& stands) const {
    constexpr int kSteps = 256;
    double best = from;
    for (const Stand& stand : stands) {
      Joints at = stand.joints;
      double good = from;
      const auto goes_to = [&](double t) {
        const Joints joints = joints_of(row, motion.at(t), stand.branch, at);
        if (!within(joints)) return false;
        at = joints, good = t;
        return true;
      };
      int step = 1;
      while (step <= kSteps && goes_to(from + (1 - from) * step / kSteps)) ++step;
      double bad = from + (1 - from) * std::min(step, kSteps) / kSteps;
      for (int k = 0; k < 60 && bad - good > 1e-15; ++k)
        if (const double middle = (good + bad) / 2; !goes_to(middle)) bad = middle;
      best = std::max(best, good);
    }
    return best;
  }

  void keep(Node node, Stands stands) {
    node.begin = traces_.size();
    nodes_.push_back(node);
    for (const Stand& s : stands)
      traces_.push_back({rotary_.empty() ? 0 : s.joints[rotary_[0]], rotary_.size() < 2 ? 0 : s.joints[rotary_[1]],
                         s.from, s.branch});
    stands_ = std::move(stands);
  }

  std::vector<Waypoint> traced() const {
    const auto best =
        std::min_element(stands_.begin(), stands_.end(), [](const Stand& a, const Stand& b) { return a.better(b); });
    auto at = static_cast<std::size_t>(best - stands_.begin());
    std::vector<Waypoint> out(nodes_.size());
    for (std::size_t n = nodes_.size(); n-- > 0;) {
      const Node& node = nodes_[n];
      const Trace& trace = traces_[node.begin + at];
      Joints joints{};
      if (!rotary_.empty()) joints[rotary_[0]] = trace.first;
      if (rotary_.size() > 1) joints[rotary_[1]] = trace.second;
      const Vec3 tip = node.share < 1 ? Motion(pose(node.row - 1), pose(node.row)).tip(node.share) : pose(node.row).tip;
      out[n] = {node.row, node.share, machine_.with_tip(joints, tip), node.rewound};
      at = trace.from;
    }
    // Omit the waypoint where unwinding was possible but this path did not need it.
    std::vector<Waypoint> kept;
    for (const Waypoint& w : out)
      if (!w.rewound || rotary_way(kept.back().joints, w.joints) > 1e-6) kept.push_back(w);
    return kept;
  }

  [[noreturn]] void refuse(std::size_t row, const Pose& pose) const {
    std::string text = "machine " + machine_.name() + " cannot hold it within its limits:";
    for (int b = 0; b < machine_.branches(); ++b) {
      const Joints joints = joints_of(row, pose, b, {});
      if (const std::size_t k = machine_.beyond(joints, kSlack); k < joints.size()) {
        const AxisRange& range = machine_.range(k);
        char part[128];
        std::snprintf(part, sizeof part, "%s %c would stand at %.6g (%.6g to %.6g)", b ? ";" : "", kJointLetters[k],
                      joints[k], range.low, range.high);
        text += part;
      }
    }
    if (text.back() == ':') text += " along the great circle from the row before";
    throw RowError("poses", row, text + "; place the part differently or tilt the tool less");
  }

  const Program& program_;
  const Machine& machine_;
  double axis_tolerance_;
  const std::vector<bool>& free_;
  std::vector<std::size_t> rotary_;  // indices in Joints
  Stands stands_;                    // stands of the last node
  std::vector<Node> nodes_;
  std::vector<Trace> traces_;
};

}  // namespace

std::vector<bool> free_moves(const Program& program, std::optional<double> safe_height) {
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < program.size(); ++row) {
    if (program.rapid()[row]) continue;
    const double z = program.poses()[row].tip.z;
    if (safe_height && z >= *safe_height)
      throw RowError("poses", row,
                     "safe_height " + number_text(*safe_height) + " must be above every feed move: " + number_text(z));
    highest = std::max(highest, z);
  }
  const auto safe = [&](std::size_t row) {
    const double z = program.poses()[row].tip.z;
    return safe_height ? z >= *safe_height : z > highest;
  };
  std::vector<bool> out(program.size());
  for (std::size_t row = 1; row < program.size(); ++row)
    out[row] = program.tool()[row] != program.tool()[row - 1] || !program.moves_in_part(row) ||
               (program.rapid()[row] && safe(row - 1) && safe(row));
  return out;
}

std::vector<Waypoint> choose_joints(const Program& program, const Machine& machine, double axis_tolerance,
                                    const std::vector<bool>& free) {
  return Chooser(program, machine, axis_tolerance, free).run();
}

}  // namespace riffler::nc
