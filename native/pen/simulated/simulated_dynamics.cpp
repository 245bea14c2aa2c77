#include "pen/simulated/simulated_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/functions.hpp"
#include "pen/arms/wrench_split.hpp"

namespace riffler::pen {

namespace {

constexpr double kMilli = 1e-3;  // kg to N·s²/mm, kg·mm² to N·mm·s²
/// Stops at the joints' limits: stiffness N·mm/rad, stiff for a hand and soft for a step, and damping N·mm·s/rad.
constexpr double kStop = 5e4, kStopDrag = 20;

double& entry(JointAngles& angles, std::size_t k) {
  return angles[k / 3][static_cast<int>(k % 3)];
}
double entry(const JointAngles& angles, std::size_t k) {
  return angles[k / 3][static_cast<int>(k % 3)];
}

JointVector vector_of(const JointAngles& angles) {
  JointVector out;
  for (std::size_t k = 0; k < kJoints; ++k) out[k] = entry(angles, k);
  return out;
}

/// How far `angle` is outside its limits: negative below, positive above.
double beyond(double angle, double low, double high) {
  return std::min(angle - low, 0.0) + std::max(angle - high, 0.0);
}

}  // namespace

Vec3 turn_between(const Vec3& from, const Vec3& to) noexcept {
  const Vec3 normal = glm::cross(from, to);
  const double sine = glm::length(normal);
  return sine > 0 ? base::atan2(sine, glm::dot(from, to)) / sine * normal : Vec3(0);
}

PenDynamics::PenDynamics(const PenGeometry& geometry)
    : pen_(geometry), grip_mass_(kMilli * geometry.grip_mass), grip_inertia_(kMilli * geometry.grip_inertia) {
  for (const PenChannel& c : geometry.channels) {
    const std::size_t k = 3 * index(c.arm) + static_cast<std::size_t>(c.joint);
    inertia_[k] = kMilli * c.inertia;
    viscous_[k] = c.viscous * c.ratio * c.ratio;
    coulomb_[k] = c.coulomb * c.ratio;
    // The braking current is the motor's voltage, 1e-3 · torque_constant V·s/rad, over its resistance.
    brake_[k] = kMilli * c.torque_constant * c.torque_constant / c.resistance * c.ratio * c.ratio;
    low_[k] = c.low, high_[k] = c.high;
  }
  if (!place(pen_.posture(pen_.home_angles()).pose))
    throw std::invalid_argument("geometry: the pen does not reach its home posture with the grip's length");
}

bool PenDynamics::place(const Pose& pose) {
  const PenInverse found = pen_.inverse(pose);
  if (!found.reached()) return false;
  posture_ = pen_.posture(found.angles);
  forget_posture();
  rates_ = {};
  rubbing_ = {};
  account_ = {};
  return true;
}

void PenDynamics::step(const PenLoad& load, double seconds) {
  hold(load);
  kick(load, seconds / 2);
  drift(seconds);
  kick(load, seconds / 2);
}

/// Changes the mass that holds the grip: it joins and leaves at the grip's speed, with its energy.
void PenDynamics::hold(const PenLoad& load) {
  const double mass = kMilli * load.mass, inertia = kMilli * load.inertia;
  if (mass == held_mass_ && inertia == held_inertia_) return;
  const double before = kinetic();
  held_mass_ = mass, held_inertia_ = inertia;
  forget_posture();
  account_.hand += kinetic() - before;
}

/// For the inertia plus half the damping over `time` with a load.
JointMobility PenDynamics::mobility(const JointReach& reach, const PenLoad* load, double time) const {
  const double share = load ? time / 2 : 0;
  const haptics::Bounds damping = load ? load->damping : haptics::Bounds{0, 0};
  const double mass = grip_mass_ + held_mass_ + share * damping.linear;
  const double turning = (grip_inertia_ + held_inertia_ + share * damping.angular) / (reach.length * reach.length);
  std::array<JointVector, kJoints> matrix{};
  for (std::size_t i = 0; i < kJoints; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      matrix[i][j] =
          mass * glm::dot(reach.middle[i], reach.middle[j]) + turning * glm::dot(reach.apart[i], reach.apart[j]);
  const JointVector drags = load ? drag(*load) : JointVector{};
  for (std::size_t k = 0; k < kJoints; ++k) matrix[k][k] += inertia_[k] + share * drags[k];
  return {matrix, reach.stretch()};
}

/// N·mm·s/rad at the joints: bearings, shorted motors, stops.
JointVector PenDynamics::drag(const PenLoad& load) const {
  JointVector out;
  for (std::size_t k = 0; k < kJoints; ++k) {
    const bool stopped = beyond(entry(posture_.angles, k), low_[k], high_[k]) != 0;
    out[k] = viscous_[k] + (load.brake ? brake_[k] : 0) + (stopped ? kStopDrag : 0);
  }
  return out;
}

JointVector PenDynamics::stop_torques() const {
  JointVector out;
  for (std::size_t k = 0; k < kJoints; ++k) out[k] = -kStop * beyond(entry(posture_.angles, k), low_[k], high_[k]);
  const PenGeometry& g = pen_.geometry();
  for (std::size_t arm = 0; arm < 2; ++arm) {
    const Vec3& angles = posture_.angles[arm];
    const double push = -kStop * beyond(angles.y - angles.z, g.elbow_low, g.elbow_high);
    out[3 * arm + 1] += push, out[3 * arm + 2] -= push;
  }
  return out;
}

JointVector PenDynamics::weight_torques() const {
  JointVector out = vector_of(gravity_torques(pen_.geometry(), posture_.angles));
  for (double& torque : out) torque = -torque;
  return out;
}

/// All forces that do not depend on the speed.
Wrench PenDynamics::hand(const PenLoad& load) const {
  const Pose& is = posture_.pose;
  const Vec3 force = load.stiffness.linear * (load.aim.tip - is.tip);
  const Vec3 torque = load.stiffness.angular * turn_between(is.axis, load.aim.axis);
  return load.wrench +
         Wrench{geom::clamp_length(force, load.strength.linear) + load.damping.linear * load.drift.linear,
                geom::clamp_length(torque, load.strength.angular) + load.damping.angular * load.drift.angular};
}

JointVector PenDynamics::pushed(const JointReach& reach, const Wrench& wrench) const {
  const Wrench in_base{pen_.to_base(wrench.force), pen_.to_base(wrench.torque)};
  // A torque turns the ends about each other: as a force on r_L − r_R it is τ × r / |r|².
  const Vec3 couple = glm::cross(in_base.torque, posture_.apart);
  return reach.back(1, in_base.force, 1, couple);
}

double PenDynamics::kinetic() const {
  const JointVector v = vector_of(rates_);
  const JointReach reach(posture_);
  const Vec3 middle = reach.of_middle(v), turning = reach.of_apart(v) / reach.length;
  double twice = (grip_mass_ + held_mass_) * glm::dot(middle, middle) +
                 (grip_inertia_ + held_inertia_) * glm::dot(turning, turning);
  for (std::size_t k = 0; k < kJoints; ++k) twice += inertia_[k] * v[k] * v[k];
  return 0.5 * twice;
}

/// The potential energy whose derivatives are weight_torques() and stop_torques().
double PenDynamics::potential() const {
  const PenGeometry& g = pen_.geometry();
  double out = 0;
  for (const PenChannel& c : g.channels) {
    const double angle = posture_.angles[index(c.arm)][c.joint];
    if (c.joint != 0) out += c.gravity * (c.joint == 1 ? -base::cos(angle) : base::sin(angle));
  }
  for (std::size_t k = 0; k < kJoints; ++k) {
    const double way = beyond(entry(posture_.angles, k), low_[k], high_[k]);
    out += 0.5 * kStop * way * way;
  }
  for (const Vec3& angles : posture_.angles) {
    const double way = beyond(angles.y - angles.z, g.elbow_low, g.elbow_high);
    out += 0.5 * kStop * way * way;
  }
  return out;
}

PenEnergy PenDynamics::energy() const {
  PenEnergy out = account_;
  out.kinetic = kinetic();
  out.potential = potential();
  return out;
}

/// What the drift needs: the inertia without a load.
const PenDynamics::Free& PenDynamics::free() {
  if (!free_) {
    const JointReach reach(posture_);
    free_ = Free{reach, mobility(reach, nullptr, 0)};
  }
  return *free_;
}

/// What a kick needs. A step ends with a kick at the posture at which the next one begins with a kick, most often with
/// the same damping.
const PenDynamics::Loaded& PenDynamics::loaded(const PenLoad& load, double time) {
  if (loaded_ && loaded_->time == time && loaded_->brake == load.brake &&
      loaded_->damping.linear == load.damping.linear && loaded_->damping.angular == load.damping.angular)
    return *loaded_;
  const JointReach reach(posture_);
  const JointMobility mobility = this->mobility(reach, &load, time);
  loaded_ = Loaded{time,           load.damping,      load.brake, reach, mobility, drag(load), weight_torques(),
                   stop_torques(), mobility.columns()};
  return *loaded_;
}

void PenDynamics::forget_posture() {
  free_.reset(), loaded_.reset();
}

/// Applies all forces for `time` at a fixed posture: M Δv = time · (f − B v̄) − friction's impulse, v̄ the mean of both
/// ends.
void PenDynamics::kick(const PenLoad& load, double time) {
  const Loaded& at = loaded(load, time);
  const JointReach& reach = at.reach;
  const JointVector before = vector_of(rates_);
  const JointVector motors = vector_of(joint_torques(pen_.geometry(), load.motors));
  const JointVector hand = pushed(reach, this->hand(load));
  const auto held_back = [&](const JointVector& v) {
    return reach.back(load.damping.linear, reach.of_middle(v), load.damping.angular, reach.of_apart(v));
  };
  const JointVector held = held_back(before);
  JointVector impulse;
  for (std::size_t k = 0; k < kJoints; ++k)
    impulse[k] = time * (motors[k] + hand[k] + (1 - load.borne) * at.weight[k] + at.stops[k] - held[k] -
                         at.drags[k] * before[k]);
  JointVector v = at.mobility.solve(impulse, -dot(at.mobility.stretch, before));
  for (std::size_t k = 0; k < kJoints; ++k) v[k] += before[k];

  // Dry friction minimises the remaining energy: one joint after the other until none changes (projected Gauss–Seidel;
  // converges because the matrix is positive definite).
  const auto rub = [&](std::size_t k, double by) {
    for (std::size_t i = 0; i < kJoints; ++i) v[i] -= by * at.columns[k][i];
  };
  for (std::size_t k = 0; k < kJoints; ++k) rub(k, time * rubbing_[k]);
  for (int sweep = 0; sweep < 100; ++sweep) {
    double changed = 0;
    for (std::size_t k = 0; k < kJoints; ++k) {
      if (coulomb_[k] == 0) continue;
      const double last = rubbing_[k];
      rubbing_[k] = std::clamp(last + v[k] / (time * at.columns[k][k]), -coulomb_[k], coulomb_[k]);
      rub(k, time * (rubbing_[k] - last));
      changed = std::max(changed, std::abs(rubbing_[k] - last) / coulomb_[k]);
    }
    if (changed <= 1e-9) break;
  }

  JointVector mean;
  for (std::size_t k = 0; k < kJoints; ++k) mean[k] = 0.5 * (before[k] + v[k]), entry(rates_, k) = v[k];
  account_.motors += time * dot(motors, mean);
  account_.hand += time * (dot(hand, mean) - dot(held_back(mean), mean));
  account_.borne -= time * load.borne * dot(at.weight, mean);
  for (std::size_t k = 0; k < kJoints; ++k) account_.lost += time * (at.drags[k] * mean[k] + rubbing_[k]) * mean[k];
}

/// Free motion for `time`: the momentum that leaves a posture arrives at the next.
void PenDynamics::drift(double time) {
  const auto& [from, mobility] = free();
  const PenPosture start = posture_;
  const Vec3 start_middle = 0.5 * (start.arms[0].end + start.arms[1].end);
  const double mass = grip_mass_ + held_mass_, inertia = grip_inertia_ + held_inertia_;
  const JointVector rates = vector_of(rates_);
  const Vec3 middle_rate = from.of_middle(rates), apart_rate = from.of_apart(rates);

  JointVector way;
  for (std::size_t k = 0; k < kJoints; ++k) way[k] = time * rates[k];
  Vec3 went(0), turned(0);
  for (int round = 0; round < 20; ++round) {
    JointAngles angles = start.angles;
    for (std::size_t k = 0; k < kJoints; ++k) entry(angles, k) += way[k];
    posture_ = pen_.posture(angles);
    went = 0.5 * (posture_.arms[0].end + posture_.arms[1].end) - start_middle;
    turned = posture_.apart - start.apart;
    JointVector missing = from.back(mass, went - time * middle_rate, inertia, turned - time * apart_rate);
    for (std::size_t k = 0; k < kJoints; ++k) missing[k] = -missing[k] - inertia_[k] * (way[k] - time * rates[k]);
    const double length = pen_.geometry().grip_length;
    const JointVector change = mobility.solve(missing, length - posture_.length);
    double largest = 0;
    for (const double c : change) largest = std::max(largest, std::abs(c));
    if (largest <= 1e-14) break;
    for (std::size_t k = 0; k < kJoints; ++k) way[k] += change[k];
  }

  forget_posture();
  const Free& to = free();
  JointVector momentum = to.reach.back(mass, went / time, inertia, turned / time);
  for (std::size_t k = 0; k < kJoints; ++k) momentum[k] += inertia_[k] * way[k] / time;
  const JointVector v = to.mobility.solve(momentum, 0);
  for (std::size_t k = 0; k < kJoints; ++k) entry(rates_, k) = v[k];
}

}  // namespace riffler::pen
