#include "riffler/pen/capability.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "geom/math.hpp"
#include "pen/arms/wrench_split.hpp"
#include "riffler/pen/arms/motors.hpp"

namespace riffler::pen {

namespace {

constexpr const char* kLetters = "xyzabc";

std::string letters_of(const DeviceCapability& device, bool (*has)(const CoordinateCapability&)) {
  std::string out;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k)
    if (has(device.coordinates[k])) out += {' ', kLetters[k]};
  return out.empty() ? " nothing" : out;
}

/// Axes of A and B: perpendicular to the grip; the first closest to x, or to y if the grip lies along x.
std::pair<Vec3, Vec3> turning_axes(const Vec3& axis) {
  const Vec3 x(1, 0, 0), y(0, 1, 0), like = std::abs(axis.x) < 0.9 ? x : y;
  const Vec3 a = glm::normalize(like - glm::dot(like, axis) * axis);
  return {a, glm::cross(axis, a)};
}

/// Largest force or torque (N, N·mm) of the motors along `unit` in this posture.
struct Strength {
  double peak, continuous;
};

Strength strength(const PenKinematics& kinematics, const PenPosture& posture, const Wrench& unit, double limit) {
  const PenGeometry& pen = kinematics.geometry();
  const WrenchSplit split = split_wrench(unit, posture.apart);
  JointAngles torques{};
  for (std::size_t arm = 0; arm < 2; ++arm) torques[arm] = joint_torques(posture.arms[arm], split.forces[arm]);
  const MotorTorques motors = motor_torques(pen, torques);
  Strength out{limit, limit};
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const double size = std::abs(motors[k]);
    if (size > 0) {
      out.peak = std::min(out.peak, pen.channels[k].peak_torque() / size);
      out.continuous = std::min(out.continuous, pen.channels[k].continuous_torque() / size);
    }
  }
  return out;
}

}  // namespace

bool DeviceCapability::has_force() const {
  return std::any_of(coordinates.begin(), coordinates.end(), [](const CoordinateCapability& c) { return c.pushes; });
}

std::string capability_text(const DeviceCapability& device) {
  const auto senses = [](const CoordinateCapability& c) { return c.sensing != Sensing::None; };
  const auto pushes = [](const CoordinateCapability& c) { return c.pushes; };
  std::string out = "senses" + letters_of(device, senses) + ", pushes" + letters_of(device, pushes);
  if (!device.has_force()) return out;
  std::string missing;
  const auto add = [&](const std::string& what) { missing += (missing.empty() ? "" : ", ") + what; };
  for (std::size_t k = 0; k < 3; ++k)
    if (!device.coordinates[k].pushes) add(std::string("force along ") + kLetters[k]);
  const bool grip = device.turns == TurnAxes::Grip;
  if (grip && !(device[Coordinate::A].pushes && device[Coordinate::B].pushes))
    add("torque perpendicular to the grip's axis");
  if (grip && !device[Coordinate::C].pushes) add("torque about the grip's axis");
  for (std::size_t k = 0; k < 3 && !grip; ++k)
    if (!device.coordinates[3 + k].pushes) add(std::string("torque about ") + kLetters[k]);
  return missing.empty() ? out : out + "; the hand does not feel: " + missing;
}

haptics::Capability pushed(const DeviceCapability& device, const Vec3& axis) noexcept {
  haptics::Capability out;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) out.push[k] = device.coordinates[k].pushes;
  if (device.turns == TurnAxes::Device) return out;
  const auto [a, b] = turning_axes(axis);
  out.axes = Mat3(a, b, axis);
  out.push[0] = out.push[1] = out.push[2] = out.push[0] && out.push[1] && out.push[2];
  out.push[3] = out.push[4] = out.push[3] && out.push[4];
  return out;
}

DeviceCapability pen_capability(const PenGeometry& pen) {
  const PenKinematics kinematics(pen);
  const PenPosture home = kinematics.posture(kinematics.home_angles());
  const Vec3 axis = kinematics.to_base(home.pose.axis);
  const auto [a, b] = turning_axes(axis);
  DeviceCapability out;
  out.name = pen.name;
  out.turns = TurnAxes::Grip;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    CoordinateCapability& c = out.coordinates[k];
    c.sensing = Sensing::Position;
    c.pushes = k + 1 < haptics::kCoordinates;
    Vec3 direction = k == 3 ? a : k == 4 ? b : axis;
    if (k < 3) {
      const int i = static_cast<int>(k);
      direction = Vec3(0), direction[i] = 1;
      c.low = pen.workspace.lower[i], c.high = pen.workspace.upper[i];
    }
    if (!c.pushes) continue;
    const Wrench unit = k < 3 ? Wrench{direction, Vec3(0)} : Wrench{Vec3(0), direction};
    const Strength most = strength(kinematics, home, unit, k < 3 ? pen.force : pen.torque);
    c.peak = most.peak, c.continuous = most.continuous;
    for (const PenChannel& channel : pen.channels) {
      JointAngles one{};
      one[index(channel.arm)][channel.joint] = kTwoPi / channel.steps;
      const PenSpeed step = kinematics.speed(home, one);
      const Vec3 change = kinematics.to_base(k < 3 ? step.twist.linear : step.twist.angular);
      c.resolution = std::max(c.resolution, std::abs(glm::dot(change, direction)));
    }
  }
  out[Coordinate::C].resolution = kTwoPi / pen.probe_steps;
  return out;
}

}  // namespace riffler::pen
