#include "riffler/pen/arms/kinematics.hpp"

#include <cmath>

#include "geom/math.hpp"

namespace riffler::pen {

namespace {

/// Counts between two readings of a 32-bit counter that may have wrapped.
std::int32_t counted(std::int32_t from, std::int32_t to) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(to) - static_cast<std::uint32_t>(from));
}

/// The counter's reading for `angle`: the inverse of (2.9).
std::int32_t reading(double angle, double steps, int sign, std::int32_t home, std::int32_t at_home) {
  const double count = std::nearbyint(sign * angle * steps / kTwoPi) - home;
  const double wrapped = std::isfinite(count) ? std::remainder(count, 0x1p32) : 0;
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(at_home) +
                                   static_cast<std::uint32_t>(static_cast<std::int64_t>(wrapped)));
}

}  // namespace

double within_a_turn(double angle) noexcept {
  const double least = std::remainder(angle, kTwoPi);
  return least <= -kPi ? least + kTwoPi : least;
}

PenKinematics::PenKinematics(const PenGeometry& geometry)
    : geometry_(geometry), probe_at_home_(geometry.probe_home), towards_(geometry.tip == Arm::L ? -1 : 1) {
  for (std::size_t k = 0; k < kPenChannels; ++k) at_home_[k] = geometry.channels[k].home;
}

void PenKinematics::home_at(const EncoderCounts& raw, std::int32_t probe) noexcept {
  at_home_ = raw, probe_at_home_ = probe;
}

EncoderCounts PenKinematics::preset(const EncoderCounts& raw) const noexcept {
  EncoderCounts out{};
  for (std::size_t k = 0; k < kPenChannels; ++k)
    out[k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(geometry_.channels[k].home) +
                                       static_cast<std::uint32_t>(counted(at_home_[k], raw[k])));
  return out;
}

JointAngles PenKinematics::angles(const EncoderCounts& raw) const noexcept {
  JointAngles out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = geometry_.channels[k];
    const double count = static_cast<double>(c.home) + counted(at_home_[k], raw[k]);
    out[index(c.arm)][c.joint] = c.sign * count / c.steps * kTwoPi;
  }
  return out;
}

EncoderCounts PenKinematics::counts(const JointAngles& angles) const noexcept {
  EncoderCounts out{};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const PenChannel& c = geometry_.channels[k];
    out[k] = reading(angles[index(c.arm)][c.joint], c.steps, c.sign, c.home, at_home_[k]);
  }
  return out;
}

JointAngles PenKinematics::home_angles() const noexcept {
  return angles(at_home_);
}

double PenKinematics::probe_angle(std::int32_t raw) const noexcept {
  const double count = static_cast<double>(geometry_.probe_home) + counted(probe_at_home_, raw);
  return geometry_.probe_sign * count / geometry_.probe_steps * kTwoPi;
}

std::int32_t PenKinematics::probe_count(double angle) const noexcept {
  return reading(angle, geometry_.probe_steps, geometry_.probe_sign, geometry_.probe_home, probe_at_home_);
}

PenPosture PenKinematics::posture(const JointAngles& angles) const noexcept {
  PenPosture out;
  out.angles = angles;
  for (std::size_t arm = 0; arm < 2; ++arm) out.arms[arm] = arm_posture(geometry_.arms[arm], angles[arm]);
  const Vec3 &right = out.arms[index(Arm::R)].end, &left = out.arms[index(Arm::L)].end;
  out.apart = left - right;
  out.length = glm::length(out.apart);
  out.pose.tip = from_base(0.5 * (left + right)) + geometry_.origin;
  out.pose.axis = out.length > 0 ? towards_ / out.length * from_base(out.apart) : Vec3(0);
  return out;
}

PenSpeed PenKinematics::speed(const PenPosture& posture, const JointAngles& rates) const noexcept {
  const Vec3 right = posture.arms[index(Arm::R)].jacobian * rates[index(Arm::R)];
  const Vec3 left = posture.arms[index(Arm::L)].jacobian * rates[index(Arm::L)];
  PenSpeed out;
  out.twist.linear = from_base(0.5 * (left + right));
  if (posture.length > 0) {
    const Vec3 along = posture.apart / posture.length, turning = (left - right) / posture.length;
    out.twist.angular = from_base(glm::cross(along, turning));
    out.stretch = glm::dot(along, left - right);
  }
  return out;
}

bool PenKinematics::within_limits(Arm arm, const Vec3& angles) const noexcept {
  for (const PenChannel& c : geometry_.channels)
    if (c.arm == arm && !(angles[c.joint] >= c.low && angles[c.joint] <= c.high)) return false;
  const double elbow = within_a_turn(angles.y - angles.z);
  return elbow >= geometry_.elbow_low && elbow <= geometry_.elbow_high;
}

PenInverse PenKinematics::inverse(const Pose& pose) const noexcept {
  PenInverse out;
  const double length = glm::length(pose.axis);
  if (!geom::finite(pose.tip) || !std::isfinite(length) || length == 0) return out;
  const Vec3 middle = to_base(pose.tip - geometry_.origin);
  const Vec3 half = 0.5 * geometry_.grip_length * towards_ / length * to_base(pose.axis);  // towards L
  for (const Arm arm : {Arm::R, Arm::L}) {
    ArmInverse found = arm_angles(geometry_.arms[index(arm)], arm == Arm::L ? middle + half : middle - half);
    for (int k = 0; k < 3; ++k) found.angles[k] = within_a_turn(found.angles[k]);
    if (found.reach == ReachResult::Reached && !within_limits(arm, found.angles)) found.reach = ReachResult::Limits;
    out.angles[index(arm)] = found.angles, out.reach[index(arm)] = found.reach;
  }
  return out;
}

}  // namespace riffler::pen
