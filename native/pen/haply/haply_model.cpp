#include "pen/haply/haply_model.hpp"

#include <algorithm>
#include <cmath>

#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {
namespace {

constexpr double kMetre = 1000;   // mm
constexpr double kSmooth = 0.02;  // s: a wireless grip's orientation arrives in steps, about a hundred a second
const Vec3 kOwnAxis(0, -1, 0);    // a grip points along its own +y (tutorial 06)

DeviceCapability capability_of(std::string_view model, bool grip) {
  DeviceCapability out;
  out.name = model.empty() ? "Inverse3" : std::string(model);
  out.turns = TurnAxes::Grip;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    CoordinateCapability& c = out.coordinates[k];
    c.pushes = k < 3;
    if (k < 3 || grip) c.sensing = Sensing::Position;
    if (c.pushes) c.peak = c.continuous = HaplyModel::kMostForce;
  }
  return out;
}

}  // namespace

HaplyModel::HaplyModel(const HaplyMessage& inventory, std::string_view id, const HaplyVersion& version)
    : id_(id), turn_(kOwnAxis, kSmooth) {
  check(inventory, version);
  std::size_t n = 0;
  while (inventory.nth(false, n)->id != id) ++n;
  model_ = inventory.nth(false, n)->model;
  if (const HaplyEntry* const grip = inventory.nth(true, n)) grip_ = grip->id;
  capability_ = capability_of(model_, !grip_.empty());
}

std::string HaplyModel::about() const {
  return "arm " + id_ + (grip_.empty() ? ", no grip: the tool keeps its axis" : ", grip " + grip_) +
         "; Inverse Service " + std::to_string(version_.major) + "." + std::to_string(version_.minor);
}

MessageSizes HaplyModel::sizes() const noexcept {
  return {65536, kLongestHaplyCommand};
}

void HaplyModel::check(const HaplyMessage& inventory, const HaplyVersion& version) {
  if (version.major != 3 || version.minor < 1)
    throw OpenError(OpenProblem::OtherVersion, "the Inverse Service has version " + std::to_string(version.major) +
                                                   "." + std::to_string(version.minor) +
                                                   "; Riffler speaks with 3.1 and later versions of 3");
  const HaplyEntry* const arm = inventory.named(false, id_);
  if (arm == nullptr)
    throw OpenError(OpenProblem::Unplugged, "the Inverse Service has no arm " + id_ + "; is it plugged in?");
  if (arm->in_use.value_or(false))
    throw OpenError(OpenProblem::Busy, "another program uses the arm; its forces would be added. Close that program");
  version_ = version;
  calibrated_ = supplied_ = ready_ = false;
  see(*arm);
}

void HaplyModel::see(const HaplyEntry& arm) noexcept {
  calibrated_ = arm.calibrated.value_or(calibrated_);
  supplied_ = arm.power_supply.value_or(supplied_);
  ready_ = arm.ready.value_or(ready_);
}

void HaplyModel::begin(double) noexcept {
  sample_.velocity = sample_.turning = Vec3(0);
  sample_.homed = sample_.powered = false;
  turn_.begin();
}

Taken HaplyModel::take(std::span<const std::uint8_t> bytes, double now) noexcept {
  HaplyMessage message;
  Taken taken;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const HaplyEntry* arm = nullptr;
  if (read_haply_message(text, message)) arm = message.named(false, id_);
  if (arm == nullptr || !arm->position) {
    ++taken.malformed;
    return taken;
  }
  place(*arm, now);
  const HaplyEntry* const grip = grip_.empty() ? nullptr : message.named(true, grip_);
  if (grip != nullptr) {
    if (grip->orientation) {
      const auto [w, x, y, z] = *grip->orientation;
      turn_.turn({w, {x, y, z}}, now, sample_);
    }
    if (grip->buttons) sample_.buttons = *grip->buttons;
  }
  ++taken.reports;
  return taken;
}

void HaplyModel::place(const HaplyEntry& arm, double now) noexcept {
  see(arm);
  sample_.pose.tip = kMetre * *arm.position;
  if (arm.velocity) sample_.velocity = kMetre * *arm.velocity;
  sample_.powered = supplied_ && ready_;
  // An arm that was off moved unseen: the gate trips, and the force returns with a reset and the ramp.
  sample_.homed = calibrated_ && sample_.powered;
  sample_.time = now;
  ++sample_.sequence;
}

std::size_t HaplyModel::push(const haptics::SafeWrench& safe, double, std::span<std::uint8_t> bytes) noexcept {
  Vec3 force(0);
  if (safe.open() && sample_.homed) {
    force = safe.wrench().force;
    const double length = glm::length(force);
    if (length > kMostForce) force *= kMostForce / length;
  }
  return write_haply_force(id_, force, version_, bytes);
}

std::size_t HaplyModel::release(double, std::span<std::uint8_t> bytes) noexcept {
  return write_haply_force(id_, Vec3(0), version_, bytes);
}

}  // namespace riffler::pen
