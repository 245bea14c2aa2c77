#include "pen/models/spacemouse_model.hpp"

#include <algorithm>
#include <stdexcept>

namespace riffler::pen {
namespace {

constexpr std::uint16_t kLogitech = 0x046D, k3Dconnexion = 0x256F;
constexpr double kFull = 350;
constexpr std::uint8_t kTranslation = 1, kRotation = 2, kButtons = 3;
constexpr std::uint16_t kGenericDesktop = 1, kMultiAxis = 8;

struct Puck {
  std::uint16_t vendor, product;
  const char* name;
};

// Numbers as in the list of USB IDs (linux-usb.org/usb.ids of 2025-07-26), except for the module and the two Bluetooth
// devices, which it lacks. Logitech's are from before 2013.
constexpr Puck kPucks[] = {
    {kLogitech, 0xC603, "SpaceMouse Plus"},
    {kLogitech, 0xC605, "CADman"},
    {kLogitech, 0xC606, "SpaceMouse Classic"},
    {kLogitech, 0xC621, "SpaceBall 5000"},
    {kLogitech, 0xC623, "SpaceTraveler"},
    {kLogitech, 0xC625, "SpacePilot"},
    {kLogitech, 0xC626, "SpaceNavigator"},
    {kLogitech, 0xC627, "SpaceExplorer"},
    {kLogitech, 0xC628, "SpaceNavigator for Notebooks"},
    {kLogitech, 0xC629, "SpacePilot Pro"},
    {kLogitech, 0xC62B, "SpaceMouse Pro"},
    {k3Dconnexion, 0xC62E, "SpaceMouse Wireless (cable)"},
    {k3Dconnexion, 0xC62F, "SpaceMouse Wireless (receiver)"},
    {k3Dconnexion, 0xC631, "SpaceMouse Pro Wireless (cable)"},
    {k3Dconnexion, 0xC632, "SpaceMouse Pro Wireless (receiver)"},
    {k3Dconnexion, 0xC633, "SpaceMouse Enterprise"},
    {k3Dconnexion, 0xC635, "SpaceMouse Compact"},
    {k3Dconnexion, 0xC636, "SpaceMouse Module"},
    {k3Dconnexion, 0xC638, "SpaceMouse Pro Wireless (Bluetooth)"},
    {k3Dconnexion, 0xC63A, "SpaceMouse Wireless (Bluetooth)"},
    {k3Dconnexion, 0xC652, "Universal Receiver"},
};

std::int16_t int16_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[at] | (bytes[at + 1] << 8)));
}

/// Three deflections from the puck's axes to the device axes, clamped to full deflection: pucks overshoot slightly.
Vec3 deflection_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  const auto share = [&](std::size_t k) { return std::clamp(int16_at(bytes, at + 2 * k) / kFull, -1.0, 1.0); };
  return {share(0), -share(1), -share(2)};
}

DeviceCapability rate_capability(const char* name, const RateSettings& settings) {
  DeviceCapability out;
  out.name = name;
  out.turns = TurnAxes::Device;
  for (std::size_t k = 0; k < haptics::kCoordinates; ++k) {
    CoordinateCapability& c = out.coordinates[k];
    c.sensing = Sensing::Rate;
    c.high = k < 3 ? settings.speed : settings.turn_rate;
    c.low = -c.high;
    c.resolution = c.high / kFull;
  }
  return out;
}

}  // namespace

const char* spacemouse_name(std::uint16_t vendor, std::uint16_t product) noexcept {
  for (const Puck& puck : kPucks)
    if (puck.vendor == vendor && puck.product == product) return puck.name;
  return nullptr;
}

SpaceMouseModel::SpaceMouseModel(HidTransport& transport, const HidInfo& info, const RateSettings& settings)
    : control_(settings) {
  const char* const name = spacemouse_name(info.vendor, info.product);
  capability_ = rate_capability(name != nullptr ? name : "SpaceMouse", settings);
  check(transport);
}

std::string SpaceMouseModel::about() const {
  return "sets speeds; no force";
}

void SpaceMouseModel::check(HidTransport& transport) {
  HidReports reports;
  try {
    reports = parse_descriptor(transport.descriptor());
  } catch (const std::invalid_argument& error) {
    throw OpenError(OpenProblem::WrongDescriptor, error.what());
  }
  const std::uint16_t translation = reports.input[kTranslation], rotation = reports.input[kRotation];
  if (!reports.has_usage(kGenericDesktop, kMultiAxis) || (translation < 12 && (translation < 6 || rotation < 6)))
    throw OpenError(OpenProblem::WrongDescriptor,
                    "its report descriptor is not that of a puck (a multi-axis controller with six axes)");
  sizes_ = reports.input;
}

void SpaceMouseModel::begin(double) noexcept {
  // Discard the last deflection from before the disconnect.
  translation_ = rotation_ = Vec3(0);
  control_.push(translation_, rotation_);
  control_.rest();
  sample_.buttons = 0;
  sample_.homed = true;
}

Taken SpaceMouseModel::take(std::span<const std::uint8_t> bytes, double now) noexcept {
  Taken taken;
  while (!bytes.empty()) {
    const std::size_t size = take_one(bytes, now, taken);
    if (size == 0) {
      ++taken.malformed;
      break;
    }
    bytes = bytes.subspan(size);
  }
  return taken;
}

std::size_t SpaceMouseModel::take_one(std::span<const std::uint8_t> bytes, double now, Taken& taken) noexcept {
  const std::uint8_t number = bytes[0];
  const std::size_t size = sizes_[number];
  if (size == 0 || bytes.size() < 1 + size) return 0;
  if (number == kTranslation) {
    translation_ = deflection_at(bytes, 1);
    if (size >= 12) rotation_ = deflection_at(bytes, 7);
    moved(now, taken);
  } else if (number == kRotation && size >= 6) {
    rotation_ = deflection_at(bytes, 1);
    moved(now, taken);
  } else if (number == kButtons) {
    sample_.buttons = 0;
    for (std::size_t k = 0; k < std::min<std::size_t>(size, 4); ++k)
      sample_.buttons |= static_cast<std::uint32_t>(bytes[1 + k]) << (8 * k);
    moved(now, taken);
  }
  return 1 + size;
}

void SpaceMouseModel::moved(double now, Taken& taken) noexcept {
  // The previous deflection applied up to now.
  control_.advance(now);
  control_.push(translation_, rotation_);
  ++taken.reports;
  ++sample_.sequence;
  sample_.time = now;
}

PenSample SpaceMouseModel::sample(double now) noexcept {
  control_.advance(now);
  sample_.pose = control_.pose();
  sample_.spin = control_.spin();
  sample_.velocity = control_.velocity();
  sample_.turning = control_.turning();
  // The puck reports only changes, so the last report is still valid.
  if (sample_.sequence > 0) sample_.time = now;
  return sample_;
}

}  // namespace riffler::pen
