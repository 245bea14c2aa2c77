#include "pen/simulated/simulated_hand.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "riffler/base/check.hpp"

namespace riffler::pen {

namespace {

/// A unit vector rotated by a rotation vector perpendicular to it.
Vec3 turned(const Vec3& axis, const Vec3& by) {
  const double angle = glm::length(by);
  if (angle == 0) return axis;
  return glm::normalize(base::cos(angle) * axis + base::sin(angle) / angle * glm::cross(by, axis));
}

/// Two directions perpendicular to `axis`.
std::pair<Vec3, Vec3> square_to(const Vec3& axis) {
  const Vec3 other = std::abs(axis.x) < 0.7 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 first = glm::normalize(glm::cross(axis, glm::cross(other, axis)));
  return {first, glm::cross(axis, first)};
}

}  // namespace

void HandSettings::validate() const {
  base::require_between(mass, 0, 100, "mass");
  base::require_between(inertia, 0, 1e6, "inertia");
  base::require_between(stiffness.linear, 0, 10, "stiffness.linear");
  base::require_between(stiffness.angular, 0, 1e5, "stiffness.angular");
  base::require_between(damping.linear, 0, 1, "damping.linear");
  base::require_between(damping.angular, 0, 1e4, "damping.angular");
  require_not_negative(strength, "strength");
  require_positive(haste, "haste");
  base::require_not_negative(tremor, "tremor");
  base::require_not_negative(tremor_frequency, "tremor_frequency");
  base::require_between(carries, 0, 1, "carries");
}

HandPath hand_on_a_curve(const Pose& home) {
  return [home, sides = square_to(home.axis)](double seconds) {
    constexpr double kRest = 1, kRound = 4, kWay = 20, kLean = 0.2;
    HandWish wish{.pose = home};
    if (seconds <= kRest) return wish;
    const double turn = kTwoPi * (seconds - kRest) / kRound;
    // Starts smoothly at home: each term is zero at the beginning.
    wish.pose.tip += kWay * (base::sin(turn) * sides.first + 0.5 * (1 - base::cos(turn)) * sides.second +
                             0.3 * base::sin(2 * turn) * home.axis);
    wish.pose.axis = glm::normalize(
        home.axis + kLean * (base::sin(turn) * sides.second - 0.5 * (1 - base::cos(turn)) * sides.first));
    wish.spin = 0.5 * base::sin(turn);
    wish.buttons = std::fmod(seconds - kRest, 2 * kRound) < kRound ? 1U : 0U;
    return wish;
  };
}

HandPath hand_at(const Pose& pose, double grip) {
  return [wish = HandWish{.pose = pose, .grip = grip}](double) { return wish; };
}

SimulatedHand::SimulatedHand(const HandSettings& settings, HandPath path, const Pose& start)
    : settings_(settings), path_(std::move(path)), aim_(start) {
  settings_.validate();
  wish_.pose = start;
}

/// Three frequencies without a common period, with different phases along each axis.
Vec3 SimulatedHand::tremor(double seconds) const {
  Vec3 out(0);
  for (int k = 0; k < 3; ++k) {
    const double turns = settings_.tremor_frequency * seconds;
    out[k] = base::sin(kTwoPi * (0.83 * turns + 0.31 * k)) + base::sin(kTwoPi * (turns + 0.17 * k)) +
             base::sin(kTwoPi * (1.19 * turns + 0.53 * k));
  }
  return settings_.tremor / 3 * out;
}

/// Moves the aim towards the target at the hand's speed; returns its twist.
Twist SimulatedHand::aim(double dt) {
  const Vec3 way = geom::clamp_length(wish_.pose.tip - aim_.tip, settings_.haste.linear * dt);
  const Vec3 turn = geom::clamp_length(turn_between(aim_.axis, wish_.pose.axis), settings_.haste.angular * dt);
  aim_.tip += way;
  aim_.axis = turned(aim_.axis, turn);
  return dt > 0 ? Twist{way / dt, turn / dt} : Twist{};
}

void SimulatedHand::hold(const PenDynamics& pen, double seconds, double dt, PenLoad& load) {
  if (path_) wish_ = path_(seconds);
  const double grip = std::clamp(wish_.grip, 0.0, 1.0);
  if (!(grip > 0)) {
    aim_ = pen.posture().pose;  // grips at the grip's current pose
    return;
  }
  const Twist drift = aim(dt);
  load.aim = {aim_.tip + tremor(seconds), aim_.axis};
  load.stiffness = {grip * settings_.stiffness.linear, grip * settings_.stiffness.angular};
  load.strength = settings_.strength;
  load.damping = {grip * settings_.damping.linear, grip * settings_.damping.angular};
  load.drift = drift;
  load.mass = grip * settings_.mass, load.inertia = grip * settings_.inertia;
  load.borne = grip * settings_.carries;
}

}  // namespace riffler::pen
