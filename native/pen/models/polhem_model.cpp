#include "pen/models/polhem_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/functions.hpp"
#include "geom/math.hpp"
#include "pen/hid/hid_descriptor.hpp"

namespace riffler::pen {
namespace {

// Both messages have seven 16-bit numbers, little-endian. To the host: counters a … f, then a flag of the index. To the
// device: currents of a b c (mA), a command, three attributes. Command 1 presets the counters: the attributes are those
// of a b c, the currents those of d e f, and nothing is pushed.
constexpr std::size_t kMessage = 14;
constexpr int kCommandField = 3, kFirstAttribute = 4;
constexpr std::int16_t kPreset = 1;
/// The stylus button is encoded by adding this to counter d.
constexpr int kButtonOffset = 10000;

constexpr PolhemGeometry kGeometries[] = {
    // From 2015: capstans of 10 mm, driven bodies of 160 and 120 mm.
    {"woodenhaptics",
     {16, 12, 12},
     {1, 1, 1},
     80,
     205,
     245,
     {220, 0, 80},
     {25.9, 25.9, 25.9},
     2000,
     2,
     {0, 0, 6000, 0, 0, 0}},
    // The first Polhem: 10 mm, 180 and 100 mm. Its motors are mounted in reverse.
    {"polhem-1",
     {18, 10, 10},
     {-1, -1, -1},
     58,
     174,
     133,
     {140, 0, 100},
     {53.8, 53.8, 53.8},
     2000,
     2,
     {0, 0, -5000, 0, 0, 0}},
};

std::int16_t int16_field(std::span<const std::uint8_t> bytes, std::size_t field) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(bytes[2 * field] | (bytes[2 * field + 1] << 8)));
}

void put_int16(std::span<std::uint8_t> message, std::size_t field, std::int16_t value) {
  message[2 * field] = static_cast<std::uint8_t>(value & 0xFF);
  message[2 * field + 1] = static_cast<std::uint8_t>((value >> 8) & 0xFF);
}

Vec3 angles_of(const PolhemGeometry& g, const std::array<std::int32_t, 3>& counts) {
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const auto j = static_cast<std::size_t>(k);
    out[k] = g.sign[j] * 2 * kPi * counts[j] / (g.counts * g.ratio[j]);
  }
  return out;
}

/// Whether the counts are within what a hand can move in a few reports of the preset.
bool at_preset(const PolhemGeometry& g, const std::array<std::int16_t, 6>& raw) {
  constexpr int kNear = 100;
  for (std::size_t k = 0; k < 3; ++k)
    if (std::abs(raw[k] - g.preset[k]) > kNear) return false;
  return true;
}

DeviceCapability capability_of(const PolhemGeometry& g) {
  DeviceCapability out;
  out.name = g.name;
  const PolhemPosture home = polhem_posture(g, angles_of(g, {g.preset[0], g.preset[1], g.preset[2]}));
  // The force along an axis that each joint's peak torque allows: the smallest |τ_j| / |J_ij|.
  for (int i = 0; i < 3; ++i) {
    CoordinateCapability& c = out.coordinates[static_cast<std::size_t>(i)];
    c.sensing = Sensing::Position;
    double force = std::numeric_limits<double>::infinity();
    for (int j = 0; j < 3; ++j) {
      const auto k = static_cast<std::size_t>(j);
      const double arm = std::abs(home.jacobian[j][i]);
      c.resolution = std::max(c.resolution, arm * 2 * kPi / (g.counts * g.ratio[k]));
      if (arm > 1e-9) force = std::min(force, g.torque_constant[k] * g.peak_current * g.ratio[k] / arm);
    }
    c.pushes = std::isfinite(force);
    c.peak = c.continuous = c.pushes ? force : 0;
  }
  return out;
}

}  // namespace

const PolhemGeometry* polhem_geometry(std::string_view name) noexcept {
  for (const PolhemGeometry& g : kGeometries)
    if (name == g.name) return &g;
  return nullptr;
}

PolhemPosture polhem_posture(const PolhemGeometry& g, const Vec3& angles) noexcept {
  const double ca = base::cos(angles.x), sa = base::sin(angles.x);
  const double cb = base::cos(angles.y), sb = base::sin(angles.y);
  const double cc = base::cos(angles.z), sc = base::sin(angles.z);
  const double reach = g.upper * sb + g.fore * sc;
  PolhemPosture out;
  out.tip = Vec3(ca * reach, sa * reach, g.base + g.upper * cb - g.fore * cc) - g.origin;
  out.jacobian[0] = Vec3(-sa * reach, ca * reach, 0);
  out.jacobian[1] = g.upper * Vec3(ca * cb, sa * cb, -sb);
  out.jacobian[2] = g.fore * Vec3(ca * cc, sa * cc, sc);
  return out;
}

PolhemModel::PolhemModel(HidTransport& transport, const PolhemGeometry& geometry)
    : geometry_(geometry), capability_(capability_of(geometry)) {
  check(transport);
}

std::string PolhemModel::about() const {
  return std::string("geometry ") + geometry_.name + ", three motors; the wrist's encoders are not used";
}

void PolhemModel::check(HidTransport& transport) {
  HidReports reports;
  try {
    reports = parse_descriptor(transport.descriptor());
  } catch (const std::invalid_argument& error) {
    throw OpenError(OpenProblem::WrongDescriptor, error.what());
  }
  if (reports.numbered || reports.input[0] < kMessage || reports.output[0] < kMessage || reports.output[0] > 64)
    throw OpenError(OpenProblem::WrongDescriptor,
                    "its report descriptor has no unnumbered reports of 14 to 64 bytes in both directions, as the "
                    "firmware of WoodenHaptics and Polhem has");
  input_size_ = reports.input[0];
  output_size_ = 1 + std::size_t{reports.output[0]};
}

bool PolhemModel::home() noexcept {
  home_asked_.store(true);
  return true;
}

void PolhemModel::begin(double) noexcept {
  heard_ = homing_ = false;
  // The counters live in the device, which has no clock that would reveal a loss of power.
  sample_.homed = false;
  sample_.velocity = Vec3(0);
  sample_.powered = false;
}

Taken PolhemModel::take(std::span<const std::uint8_t> bytes, double now) noexcept {
  Taken taken;
  while (bytes.size() >= input_size_) {
    place(bytes.first(kMessage), now);
    ++taken.reports;
    bytes = bytes.subspan(input_size_);
  }
  if (!bytes.empty()) ++taken.malformed;
  return taken;
}

void PolhemModel::place(std::span<const std::uint8_t> report, double now) noexcept {
  std::array<std::int16_t, 6> raw{};
  for (std::size_t k = 0; k < raw.size(); ++k) raw[k] = int16_field(report, k);
  for (std::size_t k = 0; k < counts_.size(); ++k) {
    const auto step = static_cast<std::int16_t>(static_cast<std::uint16_t>(raw[k] - raw_[k]));
    counts_[k] = heard_ ? counts_[k] + step : raw[k];
  }
  if (homing_ && at_preset(geometry_, raw)) {
    std::copy_n(raw.begin(), counts_.size(), counts_.begin());
    heard_ = homing_ = false;  // the counters jump without motion
    sample_.homed = true;
  }
  raw_ = raw;
  const Vec3 angles = angles_of(geometry_, counts_);
  posture_ = polhem_posture(geometry_, angles);
  const double dt = now - last_time_;
  if (heard_ && dt > 0) sample_.velocity = posture_.jacobian * ((angles - angles_) / dt);
  angles_ = angles;
  last_time_ = now;
  heard_ = true;
  sample_.pose.tip = posture_.tip;
  sample_.buttons = raw[3] > kButtonOffset / 2 ? 1 : 0;
  sample_.time = now;
  sample_.powered = true;
  ++sample_.sequence;
}

/// Scales all currents by one factor if one exceeds its peak, so that the force keeps its direction.
std::array<std::int16_t, 3> PolhemModel::currents(const Vec3& force) const noexcept {
  std::array<double, 3> amps{};
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    const auto j = static_cast<std::size_t>(k);
    const double torque = glm::dot(posture_.jacobian[k], force);
    amps[j] = geometry_.sign[j] * torque / geometry_.ratio[j] / geometry_.torque_constant[j];
    most = std::max(most, std::abs(amps[j]));
  }
  const double scale = most > geometry_.peak_current ? geometry_.peak_current / most : 1;
  std::array<std::int16_t, 3> out{};
  for (std::size_t j = 0; j < 3; ++j) out[j] = static_cast<std::int16_t>(1000 * scale * amps[j]);
  return out;
}

std::size_t PolhemModel::push(const haptics::SafeWrench& safe, double, std::span<std::uint8_t> bytes) noexcept {
  const auto report = bytes.first(output_size_);
  std::fill(report.begin(), report.end(), std::uint8_t{0});
  const auto message = report.subspan(1);
  if (home_asked_.exchange(false)) {
    put_int16(message, kCommandField, kPreset);
    for (std::size_t k = 0; k < 3; ++k) {
      put_int16(message, kFirstAttribute + k, geometry_.preset[k]);
      put_int16(message, k, geometry_.preset[3 + k]);
    }
    homing_ = true;
    sample_.homed = false;
  } else if (sample_.homed && heard_) {
    const std::array<std::int16_t, 3> milliamps = currents(safe.wrench().force);
    for (std::size_t k = 0; k < 3; ++k) put_int16(message, k, milliamps[k]);
  }
  return output_size_;
}

std::size_t PolhemModel::release(double, std::span<std::uint8_t> bytes) noexcept {
  const auto report = bytes.first(output_size_);
  std::fill(report.begin(), report.end(), std::uint8_t{0});
  return output_size_;
}

}  // namespace riffler::pen
