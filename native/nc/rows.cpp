#include "nc/rows.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "nc/limits.hpp"
#include "nc/number_text.hpp"

namespace riffler {

namespace {

bool same_turns(const Joints& a, const Joints& b) {
  return a[3] == b[3] && a[4] == b[4] && a[5] == b[5];
}

/// What F counts along under G94, by LinuxCNC's rule: X Y Z where one of them moves, otherwise the rotary axes.
double way_of_words(const Joints& a, const Joints& b) {
  double linear = 0, rotary = 0;
  for (std::size_t k = 0; k < a.size(); ++k) (k < 3 ? linear : rotary) += (b[k] - a[k]) * (b[k] - a[k]);
  return std::sqrt(linear > 1e-12 ? linear : rotary);
}

}  // namespace

bool NcRows::is_away(const NcRowWords& words) {
  std::string_view text = place_.text;
  while (!text.empty() && (text.back() == ' ' || text.back() == '\r' || text.back() == '\t')) text.remove_suffix(1);
  for (const std::string& retract : machine_->control().retract) {
    if (!words.rapid || !text.ends_with(retract)) continue;
    // Before it only a block's number.
    const std::string_view before = text.substr(0, text.size() - retract.size());
    if (before.find_first_not_of("Nn0123456789 ") == before.npos) return away_ = true;
  }
  return away_ = away_ && words.rapid && text.find_first_of("Zz") == text.npos;
}

void NcRows::begin(const Joints& from) {
  if (first_) return;
  first_ = frame_, as_first_ = true;
  at_ = from, last_ = machine_->pose(from);
}

Joints NcRows::in_part(const Joints& program) const {
  return as_first_ ? program : first_->to_program(frame_.to_machine(program));
}

/// Where no rotary axis has turned since the last row and X Y Z are the tip, the axis is the last one: no sines.
Pose NcRows::pose(const Joints& joints) {
  if (!machine_->joint_words() && same_turns(joints, at_)) return {{joints[0], joints[1], joints[2]}, last_.axis};
  return machine_->pose(joints);
}

void NcRows::row(const Pose& pose, double feed, const NcRowWords& words) {
  pending_.push_back({pose, feed, words.spindle, words.tool, words.line, words.rapid});
}

void NcRows::check_limits(const Joints& joints) const {
  if (machine_->limited().empty()) return;
  const std::size_t k = machine_->beyond(joints, 1e-6);
  if (k == joints.size()) return;
  const AxisRange& range = machine_->range(k);
  place_.fail(std::string(1, kJointLetters[k]) + " would stand at " + number_text(joints[k]) +
              ", beyond the limits of machine " + machine_->name() + ", " + number_text(range.low) + " to " +
              number_text(range.high) + ": place the part otherwise, or read it without limits");
}

/// mm/min of a block whose tip goes `way` mm.
double NcRows::feed_over(double way, const NcRowWords& words) const {
  if (words.rapid) return 0;
  return words.inverse_time ? std::min(way * words.feed, kMaxFeed) : words.feed;
}

void NcRows::line(const Joints& from, const Joints& end, const NcRowWords& words) {
  const bool was_away = away_;
  if (is_away(words)) return;
  // From where the first move comes nobody knows: it is one row. So is the first one after the machine's own retract.
  const bool known = first_.has_value() && !was_away;
  begin(from);
  const Joints to = in_part(end);
  check_limits(to);
  const Pose last = pose(to);
  const bool splits = known && (machine_->joint_words() || (!words.rapid && axis_tolerance_));
  const int parts = splits ? rotary_parts(to, !words.rapid) : 1;
  const bool along_words = machine_->joint_words() && !words.inverse_time && !same_turns(at_, to);
  double way = 0;
  if (parts > 1)
    for (int i = 1; i <= parts; ++i) way += glm::length(between(to, i, parts).tip - between(to, i - 1, parts).tip);
  else if (words.inverse_time || along_words)
    way = glm::length(last.tip - last_.tip);
  double feed = feed_over(way, words);
  if (along_words) feed = std::min(feed * way / way_of_words(at_, to), kMaxFeed);
  for (int i = 1; i < parts; ++i) row(between(to, i, parts), feed, words);
  row(last, feed, words);
  at_ = to, last_ = last;
}

Pose NcRows::between(const Joints& to, int i, int parts) const {
  Joints joints;
  for (std::size_t k = 0; k < joints.size(); ++k) joints[k] = at_[k] + (to[k] - at_[k]) * i / parts;
  return machine_->pose(joints);
}

/// Equal parts after which each great circle keeps to the axis's true way, where that was asked, and each line to the
/// tip's, where linear and rotary axes make it together.
int NcRows::rotary_parts(const Joints& to, bool feeds) const {
  if (same_turns(at_, to)) return 1;
  for (int parts = 1; parts <= kMaxChords; parts *= 2) {
    bool good = true;
    for (int i = 0; i < parts && good; ++i) {
      const Pose a = between(to, 4 * i, 4 * parts), b = between(to, 4 * i + 4, 4 * parts);
      // A chord between axes more than 120° apart says nothing about the way between them.
      good = glm::dot(a.axis, b.axis) > -0.5;
      const Motion straight(a, b);
      for (int k = 1; k < 4 && good; ++k) {
        const Pose is = between(to, 4 * i + k, 4 * parts);
        if (feeds && axis_tolerance_) good = glm::length(is.axis - straight.axis(k / 4.0)) <= *axis_tolerance_;
        if (machine_->joint_words()) good = good && glm::length(is.tip - straight.tip(k / 4.0)) <= chord_tolerance_;
      }
    }
    // Two parts at least: a full turn begins and ends at the same axis.
    if (good && (parts > 1 || std::abs(to[3] - at_[3]) + std::abs(to[4] - at_[4]) + std::abs(to[5] - at_[5]) < 90))
      return parts;
  }
  place_.fail("rotary axes turn too far in one block for chord_tolerance or axis_tolerance");
}

void NcRows::arc(const Joints& from, const Joints& to, const Arc& arc, std::size_t u, std::size_t v,
                 const NcRowWords& words) {
  const int chords = arc.chords(chord_tolerance_);
  if (chords > kMaxChords) place_.fail("an arc of too many chords");
  const std::size_t w = 3 - u - v;
  curve(
      from, chords, std::hypot(arc.length(), to[w] - from[w]),
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

}  // namespace riffler
