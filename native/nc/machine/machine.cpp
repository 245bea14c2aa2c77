#include "nc/machine/machine.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

#include "base/functions.hpp"
#include "geom/directions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "nc/number_text.hpp"

namespace riffler::nc {

namespace {

const Vec3 kSpindle(0, 0, 1);
/// Precision of an axis that was stored in single precision.
constexpr double kSingle = 1e-6;

Vec3 turned_about(const Vec3& p, const RotaryAxis& axis, double angle) {
  return axis.point + geom::rotate_about(p - axis.point, axis.direction, angle);
}

std::string show(const Vec3& v) {
  char text[96];
  std::snprintf(text, sizeof text, "[%.6g %.6g %.6g]", v.x + 0.0, v.y + 0.0, v.z + 0.0);
  return text;
}

/// "+Z" for a direction along a coordinate axis.
std::string show_direction(const Vec3& v) {
  for (int k = 0; k < 3; ++k)
    if (std::abs(v[k]) > 1 - 1e-12) return {v[k] > 0 ? '+' : '-', "XYZ"[k]};
  return show(v);
}

}  // namespace

Machine::Machine(MachineDescription description) : description_(std::move(description)), letters_("XYZ") {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("machine " + description_.name + ": " + what);
  };
  const std::vector<RotaryAxis>& rotary = description_.rotary;
  if (rotary.size() > 2) refuse("more than two rotary axes");
  for (const RotaryAxis& a : rotary) {
    if (a.letter < 'A' || a.letter > 'C') refuse("a rotary axis must be A, B or C");
    if (letters_.find(a.letter) != letters_.npos) refuse("two axes have one letter");
    if (!(std::abs(glm::length(a.direction) - 1) < 1e-9)) refuse("an axis direction must be a unit vector");
    if (!geom::finite(a.point)) refuse("a point on an axis is not finite");
    letters_ += a.letter, index_.push_back(joint_index(a.letter));
    // A table turns the part, so seen from the part the tool turns in the opposite direction.
    seen_.push_back(a.carries_part ? -a.direction : a.direction);
  }
  std::sort(letters_.begin() + 3, letters_.end());
  if (rotary.size() == 2) {
    if (rotary[1].carries_part && !rotary[0].carries_part) refuse("tables must come before heads");
    const double sine = glm::length(glm::cross(rotary[0].direction, rotary[1].direction));
    if (!(sine > 1e-3)) refuse("the rotary axes are parallel");
    two_ = {seen_[0], seen_[1]};
  }
  for (std::size_t k = 0; k < description_.ranges.size(); ++k) {
    AxisRange& range = description_.ranges[k];
    // A printed value must be within the limits too, so round them inwards.
    const double scale = base::pow(10.0, k >= 3 ? kAngleDecimals : kLengthDecimals);
    range.low = std::ceil(range.low * scale - 1e-3) / scale + 0.0;  // no -0
    range.high = std::floor(range.high * scale + 1e-3) / scale + 0.0;
    if (!(range.low < range.high)) refuse(std::string("the limits of ") + kJointLetters[k] + " must grow");
    if (!(range.rate > 0)) refuse(std::string("the rate of ") + kJointLetters[k] + " must be positive");
    const bool there = letters_.find(kJointLetters[k]) != letters_.npos;
    if (range.limited() && there && (k >= 3 || joint_words())) limited_.push_back(k);
  }
}

Machine::Turns Machine::turns(const Joints& joints) const {
  Turns out{};
  for (std::size_t k = 0; k < index_.size(); ++k) out[k] = joints[index_[k]] * kDegree;
  return out;
}

Vec3 Machine::axis_at(const Turns& t) const {
  Vec3 axis = kSpindle;
  for (std::size_t k = seen_.size(); k-- > 0;) axis = geom::rotate_about(axis, seen_[k], t[k]);
  return axis;
}

/// Offset of the tip from its place with the head's axes at 0.
Vec3 Machine::head_offset(const Turns& t) const {
  Vec3 tip(0);
  for (std::size_t k = index_.size(); k-- > 0;)
    if (!description_.rotary[k].carries_part) tip = turned_about(tip, description_.rotary[k], t[k]);
  return tip;
}

Vec3 Machine::tip_in_part(const Vec3& linear, const Turns& t) const {
  Vec3 p = linear + head_offset(t);
  for (std::size_t k = index_.size(); k-- > 0;)
    if (description_.rotary[k].carries_part) p = turned_about(p, description_.rotary[k], -t[k]);
  return p;
}

Vec3 Machine::linear_at(const Vec3& tip, const Turns& t) const {
  Vec3 p = tip;
  for (std::size_t k = 0; k < index_.size(); ++k)
    if (description_.rotary[k].carries_part) p = turned_about(p, description_.rotary[k], t[k]);
  return p - head_offset(t);
}

Pose Machine::pose(const Joints& j) const {
  const Turns t = turns(j);
  const Vec3 words(j[0], j[1], j[2]);
  return {joint_words() ? tip_in_part(words, t) : words, axis_at(t)};
}

Vec3 Machine::pole() const {
  if (seen_.size() == 2) return seen_[0];
  // A single axis along the spindle is always free, any other one never.
  return seen_.size() == 1 && glm::length(glm::cross(seen_[0], kSpindle)) < kSingle ? seen_[0] : Vec3(0);
}

void Machine::cannot_reach() const {
  if (index_.empty())
    throw std::invalid_argument("the axis is not (0, 0, 1), and machine " + name() + " has no rotary axes");
  throw std::invalid_argument("the rotary axes of machine " + name() + " cannot reach the axis");
}

Machine::Turns Machine::angles(const Vec3& axis, int branch, const Turns& near, double free) const {
  if (seen_.empty()) {
    if (!(axis.z > 0 && geom::hypot(axis.x, axis.y) <= kSingle)) cannot_reach();
    return {};
  }
  if (seen_.size() == 1) {
    const Vec3& k = seen_[0];
    if (std::abs(glm::dot(k, axis) - glm::dot(k, kSpindle)) > kSingle) cannot_reach();
    return {pole() != Vec3(0) ? near[0] : angle_about(k, kSpindle, axis), 0};
  }
  if (base::asin(std::min(1.0, glm::length(glm::cross(two_.first, axis)))) <= free) {
    // The free axis stays; the other one takes the axis as far as possible in the plane that results.
    const Turns out{near[0], angle_about(two_.second, kSpindle, geom::rotate_about(axis, two_.first, -near[0]))};
    // A pole may be out of reach for every angle of the other axis.
    if (geom::angle_between(axis_at(out), axis) > 2 * free + kSingle) cannot_reach();
    return out;
  }
  const auto found = two_.angles(kSpindle, axis, branch);
  if (!found) cannot_reach();
  return {found->alpha, found->beta};
}

Joints Machine::joints(const Pose& pose, int branch, const Joints& near, double free) const {
  const Turns before = turns(near);
  const Turns t = angles(pose.axis, branch, before, free);
  Joints out{};
  for (std::size_t k = 0; k < index_.size(); ++k)
    // Unchanged values stay bit-identical.
    out[index_[k]] = t[k] == before[k] ? near[index_[k]] : nearest_turn(t[k] / kDegree, near[index_[k]]);
  return with_tip(out, pose.tip);
}

Joints Machine::with_tip(const Joints& joints, const Vec3& tip) const {
  const Vec3 words = joint_words() ? linear_at(tip, turns(joints)) : tip;
  Joints out = joints;
  out[0] = words.x, out[1] = words.y, out[2] = words.z;
  return out;
}

std::size_t Machine::beyond(const Joints& joints, double slack) const {
  for (const std::size_t k : limited_) {
    const AxisRange& range = description_.ranges[k];
    if (!(joints[k] >= range.low - slack && joints[k] <= range.high + slack)) return k;
  }
  return joints.size();
}

std::string Machine::meaning() const {
  std::string out = joint_words() ? "X Y Z: joints" : "X Y Z: tip in part coordinates";
  if (!control().note.empty()) out += ", " + control().note;
  for (const RotaryAxis& a : description_.rotary)
    out += std::string("; ") + a.letter + " turns the " + (a.carries_part ? "part" : "tool") + " right-handed about " +
           show_direction(a.direction);
  return index_.empty() ? out + "; the tool stands upright" : out;
}

}  // namespace riffler::nc
