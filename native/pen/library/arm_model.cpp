#include "pen/library/arm_model.hpp"

#include <cmath>
#include <cstring>

#include "geom/math.hpp"

namespace riffler::pen {
namespace {

constexpr double kSmoothRate = 0.005;  // s

DeviceCapability capability_of_arm(const ArmTraits& traits) {
  DeviceCapability out;
  out.name = traits.name;
  const bool oriented = glm::length(traits.own_axis) > 0, ranged = traits.lower != traits.upper;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    CoordinateCapability& c = out.coordinates[k];
    const bool place = k < 3;
    if (place || oriented) c.sensing = Sensing::Position;
    c.peak = place ? traits.force : traits.torque;
    c.continuous = place ? traits.continuous : traits.torque;
    c.pushes = c.peak > 0;
    const int axis = static_cast<int>(k);
    if (place && ranged) c.low = traits.lower[axis], c.high = traits.upper[axis];
  }
  return out;
}

Vec3 at_most(const Vec3& v, double limit) {
  const double length = glm::length(v);
  return length > limit ? limit / length * v : v;
}

bool is_rotation(const Mat3& frame) {
  constexpr double kTolerance = 1e-3;
  const Mat3 square = glm::transpose(frame) * frame;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(square[i][j] - (i == j ? 1 : 0)) < kTolerance)) return false;
  return glm::determinant(frame) > 0;
}

std::size_t put_command(const ArmCommand& command, std::span<std::uint8_t> bytes) {
  std::memcpy(bytes.data(), &command, sizeof command);
  return sizeof command;
}

}  // namespace

ArmModel::ArmModel(const ArmTraits& traits)
    : traits_(traits), capability_(capability_of_arm(traits)), turn_(traits.own_axis, kSmoothRate) {}

bool ArmModel::turns() const noexcept {
  return glm::length(traits_.own_axis) > 0;
}

void ArmModel::begin(double) noexcept {
  sample_.velocity = sample_.turning = Vec3(0);
  sample_.homed = sample_.powered = false;
  turn_.begin();
}

Taken ArmModel::take(std::span<const std::uint8_t> bytes, double now) noexcept {
  Taken taken;
  ArmState state;
  const bool whole = bytes.size() == sizeof state;
  if (whole) std::memcpy(&state, bytes.data(), sizeof state);
  if (!whole || !geom::finite(state.position) || !geom::finite(state.velocity) ||
      (turns() && !is_rotation(state.frame))) {
    ++taken.malformed;
    return taken;
  }
  sample_.pose.tip = state.position;
  sample_.velocity = state.velocity;
  if (turns()) turn_.turn(quaternion_of(state.frame), now, sample_);
  sample_.buttons = state.buttons;
  sample_.fault = state.fault;
  sample_.powered = state.powered;
  // An arm that was off moved unseen: the gate trips, and the force returns with a reset and the ramp.
  sample_.homed = state.calibrated && state.powered;
  sample_.time = now;
  ++sample_.sequence;
  ++taken.reports;
  return taken;
}

std::size_t ArmModel::push(const haptics::SafeWrench& safe, double, std::span<std::uint8_t> bytes) noexcept {
  ArmCommand command;
  if (safe.open() && sample_.homed) {
    command.force = at_most(safe.wrench().force, traits_.force);
    command.torque = at_most(safe.wrench().torque, traits_.torque);
  }
  return put_command(command, bytes);
}

std::size_t ArmModel::release(double, std::span<std::uint8_t> bytes) noexcept {
  return put_command({}, bytes);
}

}  // namespace riffler::pen
