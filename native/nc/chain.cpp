#include "nc/chain.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace riffler {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
const Vec3 kSpindle(0, 0, 1);

Vec3 turned_about(const Vec3& p, const RotaryAxis& axis, double angle) {
  return axis.point + turned(p - axis.point, axis.direction, angle);
}

}  // namespace

ChainMachine::ChainMachine(Chain chain) : chain_(std::move(chain)), letters_("XYZ"), index_{} {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("machine " + chain_.name + ": " + what);
  };
  std::string letters;
  for (std::size_t k = 0; k < 2; ++k) {
    const RotaryAxis& a = chain_.rotary[k];
    if (a.letter < 'A' || a.letter > 'C') refuse("a rotary axis must be A, B or C");
    if (!(std::abs(glm::length(a.direction) - 1) < 1e-9)) refuse("an axis direction must be a unit vector");
    if (!(a.low < a.high)) refuse("the limits of an axis must grow");
    letters += a.letter, index_[k] = joint_index(a.letter);
  }
  if (letters[0] == letters[1]) refuse("two axes have one letter");
  std::sort(letters.begin(), letters.end());
  letters_ += letters;
  const double sine = glm::length(glm::cross(chain_.rotary[0].direction, chain_.rotary[1].direction));
  if (!(sine > 1e-3)) refuse("the rotary axes are parallel");
  // A table turns the part, so seen from the part the tool turns the other way.
  const auto seen = [&](std::size_t k) {
    return is_table(k) ? -chain_.rotary[k].direction : chain_.rotary[k].direction;
  };
  two_ = {seen(0), seen(1)};
}

ChainMachine::Turns ChainMachine::turns(const Joints& joints) const {
  return {joints[index_[0]] * kDegree, joints[index_[1]] * kDegree};
}

Vec3 ChainMachine::axis_at(const Turns& t) const {
  return turned(turned(kSpindle, two_.second, t.second), two_.first, t.first);
}

/// Of the tip from where it is with the head's axes at 0.
Vec3 ChainMachine::head_offset(const Turns& t) const {
  Vec3 tip(0);
  if (!is_table(1)) tip = turned_about(tip, chain_.rotary[1], t.second);
  if (!is_table(0)) tip = turned_about(tip, chain_.rotary[0], t.first);
  return tip;
}

Vec3 ChainMachine::tip_in_part(const Vec3& linear, const Turns& t) const {
  Vec3 p = linear + head_offset(t);
  if (is_table(1)) p = turned_about(p, chain_.rotary[1], -t.second);
  if (is_table(0)) p = turned_about(p, chain_.rotary[0], -t.first);
  return p;
}

Vec3 ChainMachine::linear_at(const Vec3& tip, const Turns& t) const {
  Vec3 p = tip;
  if (is_table(0)) p = turned_about(p, chain_.rotary[0], t.first);
  if (is_table(1)) p = turned_about(p, chain_.rotary[1], t.second);
  return p - head_offset(t);
}

Pose ChainMachine::pose(const Joints& j) const {
  const Turns t = turns(j);
  const Vec3 words(j[0], j[1], j[2]);
  return {chain_.tip_words ? words : tip_in_part(words, t), axis_at(t)};
}

Joints ChainMachine::joints(const Pose& pose, int branch, const Joints& near, double free) const {
  double first, second;
  if (std::asin(std::min(1.0, glm::length(glm::cross(two_.first, pose.axis)))) <= free) {
    // The free axis stays; the other one takes what the axis has in the plane that this gives it.
    first = near[index_[0]];
    second = angle_about(two_.second, kSpindle, turned(pose.axis, two_.first, -first * kDegree)) / kDegree;
  } else {
    const auto angles = two_.angles(kSpindle, pose.axis, branch);
    if (!angles) throw std::invalid_argument("the rotary axes of machine " + chain_.name + " cannot reach the axis");
    first = nearest_turn(angles->alpha / kDegree, near[index_[0]]);
    second = angles->beta / kDegree;
  }
  second = nearest_turn(second, near[index_[1]]);
  const Vec3 words = chain_.tip_words ? pose.tip : linear_at(pose.tip, {first * kDegree, second * kDegree});
  Joints out{words.x, words.y, words.z, 0, 0, 0};
  out[index_[0]] = first, out[index_[1]] = second;
  return out;
}

}  // namespace riffler
