#include "nc/read/rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "nc/limits.hpp"
#include "nc/number_text.hpp"

namespace riffler::nc {

namespace {

bool same_turns(const Joints& a, const Joints& b) {
  return a[3] == b[3] && a[4] == b[4] && a[5] == b[5];
}

/// The distance to which F refers under G94, by LinuxCNC's rule: X Y Z if one of them moves, otherwise the rotary axes.
double way_of_words(const Joints& a, const Joints& b) {
  double linear = 0, rotary = 0;
  for (std::size_t k = 0; k < a.size(); ++k) (k < 3 ? linear : rotary) += (b[k] - a[k]) * (b[k] - a[k]);
  return std::sqrt(linear > 1e-12 ? linear : rotary);
}

}  // namespace

void NcRows::begin(const Joints& from) {
  if (first_) return;
  first_ = frame_, as_first_ = true;
  at_ = from, last_ = machine_->pose(from);
}

Joints NcRows::in_part(const Joints& program) const {
  return as_first_ ? program : first_->to_program(frame_.to_machine(program));
}

/// If X Y Z are the tip and no rotary axis has moved since the last row, reuses the last axis: no sines.
Pose NcRows::pose(const Joints& joints) {
  if (!machine_->joint_words() && same_turns(joints, at_)) return {{joints[0], joints[1], joints[2]}, last_.axis};
  return machine_->pose(joints);
}

void NcRows::row(const Pose& pose, double feed, const NcRowWords& words) {
  rows().push_back({pose, feed, words.spindle, words.tool, words.line, words.rapid});
  away_ = holds_;
}

void NcRows::at_machine(const NcRowWords& words) {
  if (!first_) return;
  const double feed = words.rapid || words.inverse_time ? 0 : words.feed;
  rows().push_back({last_, feed, words.spindle, words.tool, words.line, words.rapid, true});
  away_ = true;
}

void NcRows::release(bool in_part) {
  away_ = !held_.empty() && (!in_part || held_.back().at_machine);
  for (Move& move : held_) {
    move.at_machine = move.at_machine || !in_part;
    pending_.push_back(std::move(move));
  }
  held_.clear();
  holds_ = false;
}

void NcRows::check_limits(const Joints& joints) const {
  if (machine_->limited().empty()) return;
  const std::size_t k = machine_->beyond(joints, 1e-6);
  if (k == joints.size()) return;
  const AxisRange& range = machine_->range(k);
  place_.fail(std::string(1, kJointLetters[k]) + " would stand at " + number_text(joints[k]) +
              ", beyond the limits of machine " + machine_->name() + ", " + number_text(range.low) + " to " +
              number_text(range.high) + ": place the part differently, or read it without limits");
}

/// Feed in mm/min of a block, given the distance of its tip (mm).
double NcRows::feed_over(double way, const NcRowWords& words) const {
  if (words.rapid) return 0;
  return words.inverse_time ? std::min(way * words.feed, kMaxFeed) : words.feed;
}

void NcRows::line(const Joints& from, const Joints& end, const NcRowWords& words) {
  // One row: the start of the first move is unknown, and so is that of a move from a machine position.
  const bool known = first_.has_value() && !away_;
  begin(from);
  const Joints to = in_part(end);
  check_limits(to);
  const Pose last = pose(to);
  std::vector<Pose> way;
  if (known) way = poses_on_the_way(to, words);
  const bool along_words = !away_ && machine_->joint_words() && !words.inverse_time && !same_turns(at_, to);
  double length = 0;
  Vec3 tip = last_.tip;
  for (const Pose& p : way) length += glm::length(p.tip - std::exchange(tip, p.tip));
  length += glm::length(last.tip - tip);
  double feed = feed_over(length, words);
  if (along_words) feed = std::min(feed * length / way_of_words(at_, to), kMaxFeed);
  if (machine_->joint_words() || axis_tolerance_) {
    for (const Pose& p : way) row(p, feed, words);
    way.clear();
  }
  row(last, feed, words);
  if (!way.empty()) rows().back().via = std::make_shared<const std::vector<Pose>>(std::move(way));
  at_ = to, last_ = last;
}

void NcRows::line_to_pose(const Joints& from, const Joints& to, const Pose& pose, const NcRowWords& words) {
  begin(from);
  check_limits(in_part(to));
  row(pose, words.rapid ? 0 : words.feed, words);
  at_ = in_part(to), last_ = pose;
}

Pose NcRows::between(const Joints& to, int i, int parts) const {
  Joints joints;
  for (std::size_t k = 0; k < joints.size(); ++k) joints[k] = at_[k] + (to[k] - at_[k]) * i / parts;
  return machine_->pose(joints);
}

/// Intermediate poses if the machine's axes do not lead straight from the last row to `to`.
std::vector<Pose> NcRows::poses_on_the_way(const Joints& to, const NcRowWords& words) const {
  if (words.rapid && machine_->control().rapids == "independent") return dog_leg(to);
  std::vector<Pose> out;
  const int parts = rotary_parts(to);
  if (parts > 1 && !machine_->joint_words() && !axis_tolerance_ && is_great_circle(to)) return out;
  for (int i = 1; i < parts; ++i) out.push_back(between(to, i, parts));
  return out;
}

/// Each axis moves at its own rate until it arrives. Linear axes without a known rate share one.
std::vector<Pose> NcRows::dog_leg(const Joints& to) const {
  double slowest = 0;  // slowest known linear rate
  for (std::size_t k = 0; k < 3; ++k)
    if (std::isfinite(machine_->range(k).rate)) slowest = std::max(slowest, machine_->range(k).rate);
  Joints minutes{};
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double rate = std::isfinite(machine_->range(k).rate) ? machine_->range(k).rate : slowest > 0 ? slowest : 1;
    longest = std::max(longest, minutes[k] = std::abs(to[k] - at_[k]) / rate);
  }
  double turn = 0;  // rad
  for (std::size_t k = 3; k < 6; ++k) {
    const double degrees = std::abs(to[k] - at_[k]), rate = machine_->range(k).rate;
    minutes[k] = degrees == 0 ? 0 : std::isfinite(rate) ? degrees / rate : std::max(longest, 1e-9);
    turn += degrees * kDegree;
  }
  std::vector<double> ends(minutes.begin(), minutes.end());
  std::ranges::sort(ends);
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  // As in rotary_parts: enough that each part stays on its great circle.
  const int parts = std::min(kMaxChords, 1 + static_cast<int>(turn / (2 * std::sqrt(axis_bound()))));
  std::vector<Pose> out;
  double before = 0;
  for (const double end : ends) {
    if (end == 0) continue;
    for (int i = 1; i <= parts; ++i) {
      const double now = i == parts ? end : before + (end - before) * i / parts;
      Joints joints = to;
      for (std::size_t k = 0; k < joints.size(); ++k)
        if (now < minutes[k]) joints[k] = at_[k] + (to[k] - at_[k]) * (now / minutes[k]);
      out.push_back(machine_->pose(joints));
    }
    before = end;
  }
  if (!out.empty()) out.pop_back();  // drop the end pose
  return out;
}

/// Number of equal parts such that each part's great circle and line stay near the true path of axis and tip, where
/// linear and rotary axes move together.
int NcRows::rotary_parts(const Joints& to) const {
  if (same_turns(at_, to)) return 1;
  double turn = 0;  // rad
  for (std::size_t k = 3; k < 6; ++k) turn += std::abs(to[k] - at_[k]) * kDegree;
  // The axis's acceleration over the block is at most turn², on its own path and on the great circle: each deviates
  // from uniform motion on the chord by at most an eighth of it.
  if (!machine_->joint_words() && turn * turn / 4 <= axis_bound()) return 1;
  for (int parts = 1; parts <= kMaxChords; parts *= 2) {
    bool good = true;
    for (int i = 0; i < parts && good; ++i) {
      const Pose a = between(to, 4 * i, 4 * parts), b = between(to, 4 * i + 4, 4 * parts);
      // A chord between axes more than 120° apart does not determine the path between them.
      good = glm::dot(a.axis, b.axis) > -0.5;
      const Motion straight(a, b);
      for (int k = 1; k < 4 && good; ++k) {
        const Pose is = between(to, 4 * i + k, 4 * parts);
        good = glm::length(is.axis - straight.axis(k / 4.0)) <= axis_bound();
        if (machine_->joint_words()) good = good && glm::length(is.tip - straight.tip(k / 4.0)) <= chord_tolerance_;
      }
    }
    // At least two parts: a full turn begins and ends at the same axis.
    if (good && (parts > 1 || turn < kPi / 2)) return parts;
  }
  place_.fail("rotary axes turn too far in one block for chord_tolerance or axis_tolerance");
}

/// Whether the block's axis follows the great circle as programmed: for example C turning about a vertical tool.
bool NcRows::is_great_circle(const Joints& to) const {
  constexpr int kParts = 16;
  const Motion straight(between(to, 0, kParts), between(to, kParts, kParts));
  for (int k = 1; k < kParts; ++k)
    if (glm::length(between(to, k, kParts).axis - straight.axis(static_cast<double>(k) / kParts)) > axis_bound())
      return false;
  return true;
}

void NcRows::arc(const Joints& from, const Joints& to, const Arc& arc, std::size_t u, std::size_t v,
                 const NcRowWords& words) {
  const int chords = arc.chords(chord_tolerance_);
  if (chords > kMaxChords) place_.fail("an arc with too many chords");
  const std::size_t w = 3 - u - v;
  curve(
      from, chords, geom::hypot(arc.length(), to[w] - from[w]),
      [&](double t) {
        if (t == 1) return to;
        Joints joints;
        for (std::size_t k = 0; k < joints.size(); ++k) joints[k] = from[k] + t * (to[k] - from[k]);
        const Vec2 p = arc.at(t);
        joints[u] = p.x, joints[v] = p.y;
        return joints;
      },
      words);
}

void NcRows::curve(const Joints& from, int parts, double length, const std::function<Joints(double)>& at,
                   const NcRowWords& words) {
  begin(from);
  const double feed = feed_over(length, words);
  for (int i = 1; i <= parts; ++i) {
    const Joints to = in_part(at(i < parts ? static_cast<double>(i) / parts : 1));
    check_limits(to);
    last_ = pose(to), at_ = to;
    row(last_, feed, words);
  }
}

Joints NcRows::change_machine(std::unique_ptr<Machine> machine, const Joints& at) {
  machine_ = std::move(machine);
  if (!first_) return at;
  at_ = machine_->with_tip(at_, last_.tip);
  return as_first_ ? at_ : frame_.to_program(first_->to_machine(at_));
}

}  // namespace riffler::nc
