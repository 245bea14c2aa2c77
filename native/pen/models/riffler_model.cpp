#include "pen/models/riffler_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "pen/arms/pens.hpp"
#include "pen/arms/redundancy.hpp"
#include "pen/arms/wrench_split.hpp"
#include "riffler/pen/arms/motors.hpp"

namespace riffler::pen {
namespace {

/// s by which the pen's clock may differ from the host's after a gap if the pen stayed powered.
constexpr double kClockError = 0.1;

/// Faults that cast no doubt on the pen and its pose: something was late. The firmware keeps counting during these
/// faults, and like every fault clears them with the next report that disables; the distinction is made here.
bool only_late(std::uint8_t fault) {
  return fault == RIFFLER_PEN_WATCHDOG || fault == RIFFLER_PEN_LATE_STEP;
}

std::string version_text(const riffler_pen_identity& identity) {
  return std::to_string(identity.major) + "." + std::to_string(identity.minor);
}

template <std::size_t N>
std::span<const std::uint8_t> feature(HidTransport& transport, std::uint8_t id, std::array<std::uint8_t, N>& bytes) {
  bytes[0] = id;
  const int n = transport.get_feature(bytes);
  if (n < 0)
    throw OpenError(OpenProblem::NoAnswer, "the pen does not provide feature report " + std::to_string(id) +
                                               "; unplug it and plug it in again");
  return std::span(bytes).first(std::min(static_cast<std::size_t>(n), N));
}

riffler_pen_identity ask_identity(HidTransport& transport) {
  std::array<std::uint8_t, RIFFLER_PEN_IDENTITY_SIZE> bytes{};
  const auto report = feature(transport, RIFFLER_PEN_IDENTITY_ID, bytes);
  riffler_pen_identity identity{};
  const riffler_pen_result result = riffler_pen_decode_identity(report.data(), report.size(), &identity);
  if (result == RIFFLER_PEN_OTHER_VERSION)
    throw OpenError(
        OpenProblem::OtherVersion,
        "the pen speaks version " + version_text(identity) + " of the protocol, this Riffler version " +
            std::to_string(RIFFLER_PEN_PROTOCOL_MAJOR) + "." + std::to_string(RIFFLER_PEN_PROTOCOL_MINOR) +
            (identity.major > RIFFLER_PEN_PROTOCOL_MAJOR ? "; use a newer Riffler, or the pen's firmware of this one"
                                                         : "; bring the pen's firmware up to date"));
  if (result == RIFFLER_PEN_NOT_A_PEN || result == RIFFLER_PEN_WRONG_LENGTH || result == RIFFLER_PEN_WRONG_ID)
    throw OpenError(OpenProblem::UnknownDevice,
                    std::string("not a Riffler pen: its identity report: ") + riffler_pen_result_text(result));
  if (result != RIFFLER_PEN_OK)
    throw OpenError(OpenProblem::BadContent,
                    std::string("the pen's identity report is invalid: ") + riffler_pen_result_text(result));
  return identity;
}

riffler_pen_limits ask_limits(HidTransport& transport) {
  std::array<std::uint8_t, RIFFLER_PEN_LIMITS_SIZE> bytes{};
  const auto report = feature(transport, RIFFLER_PEN_LIMITS_ID, bytes);
  riffler_pen_limits limits{};
  const riffler_pen_result result = riffler_pen_decode_limits(report.data(), report.size(), &limits);
  if (result != RIFFLER_PEN_OK)
    throw OpenError(OpenProblem::BadContent,
                    std::string("the pen's limits are invalid: ") + riffler_pen_result_text(result));
  return limits;
}

void check_descriptor(std::span<const std::uint8_t> bytes) {
  const std::span<const std::uint8_t> ours(riffler_pen_descriptor, riffler_pen_descriptor_size);
  const auto [a, b] = std::mismatch(bytes.begin(), bytes.end(), ours.begin(), ours.end());
  if (a == bytes.end() && b == ours.end()) return;
  throw OpenError(OpenProblem::WrongDescriptor,
                  "the pen's report descriptor differs from that of its protocol at byte " +
                      std::to_string(a - bytes.begin()) + " (it has " + std::to_string(bytes.size()) + " bytes, of " +
                      std::to_string(ours.size()) + "); its firmware was built from other files than it states");
}

PenGeometry geometry_of(const riffler_pen_identity& identity, const riffler_pen_limits& limits) {
  try {
    // A name in Riffler's own folder, never a path chosen by the device.
    if (std::string_view(identity.geometry).find_first_of("/\\") != std::string_view::npos)
      throw std::invalid_argument("the name of a geometry must not contain a folder");
    const std::string own = std::string(identity.geometry) + "-" + identity.serial;
    PenGeometry geometry = load_pen(is_own_pen(own) ? own : identity.geometry);
    for (std::size_t k = 0; k < kPenChannels; ++k) {
      PenChannel& channel = geometry.channels[k];
      channel.peak_current = std::min(channel.peak_current, 1e-3 * limits.peak_ma[k]);
      channel.continuous_current = std::min(channel.continuous_current, 1e-3 * limits.continuous_ma[k]);
    }
    return geometry;
  } catch (const std::exception& error) {
    throw OpenError(OpenProblem::BadContent,
                    std::string("the pen names the geometry \"") + identity.geometry + "\": " + error.what());
  }
}

riffler_pen_identity checked_identity(HidTransport& transport) {
  // In this order: a pen with another protocol version may have another descriptor too, and the version is the useful
  // message.
  const riffler_pen_identity identity = ask_identity(transport);
  check_descriptor(transport.descriptor());
  return identity;
}

}  // namespace

RifflerModel::RifflerModel(HidTransport& transport, const CompensationShares& share)
    : identity_((share.validate(), checked_identity(transport))),
      limits_(ask_limits(transport)),
      geometry_(geometry_of(identity_, limits_)),
      share_(share.of(geometry_)),
      capability_(pen_capability(geometry_)),
      kinematics_(geometry_),
      speed_(geometry_),
      losses_(geometry_, share_) {}

haptics::PassivitySettings RifflerModel::passivity() const {
  haptics::PassivitySettings out = passivity_settings(geometry_, share_);
  out.device_rate = slowest_change(geometry_, limits_.rate_ma_per_ms);  // mA/ms = A/s
  return out;
}

std::string RifflerModel::about() const {
  return "protocol " + version_text(identity_) + ", firmware " + std::to_string(identity_.firmware) + ", geometry " +
         identity_.geometry + ", serial " + identity_.serial + ", " +
         std::to_string((500000 + limits_.period_us / 2) / limits_.period_us * 2) + " reports a second";
}

void RifflerModel::check(HidTransport& transport) {
  const riffler_pen_identity identity = checked_identity(transport);
  const riffler_pen_limits limits = ask_limits(transport);
  const bool same = std::string_view(identity.geometry) == identity_.geometry &&
                    std::string_view(identity.serial) == identity_.serial && limits.period_us == limits_.period_us &&
                    std::equal(limits.peak_ma, limits.peak_ma + RIFFLER_PEN_JOINTS, limits_.peak_ma) &&
                    std::equal(limits.continuous_ma, limits.continuous_ma + RIFFLER_PEN_JOINTS, limits_.continuous_ma);
  if (!same)
    throw OpenError(OpenProblem::UnknownDevice,
                    "another pen was plugged in, or its limits have changed: open it again");
}

bool RifflerModel::home() noexcept {
  home_asked_.store(true);
  return true;
}

void RifflerModel::begin(double) noexcept {
  heard_ = false;
  speed_.clear();
  losses_.clear();
  sample_.velocity = sample_.turning = Vec3(0);
  sample_.powered = false;
}

Taken RifflerModel::take(std::span<const std::uint8_t> bytes, double now) noexcept {
  Taken taken;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min<std::size_t>(bytes.size(), RIFFLER_PEN_INPUT_SIZE))) {
    riffler_pen_input report{};
    const std::size_t size = std::min<std::size_t>(bytes.size(), RIFFLER_PEN_INPUT_SIZE);
    if (riffler_pen_decode_input(bytes.data(), size, &report) == RIFFLER_PEN_OK)
      take_report(report, now, taken);
    else
      ++taken.malformed;
  }
  return taken;
}

void RifflerModel::take_report(const riffler_pen_input& report, double now, Taken& taken) noexcept {
  if (heard_) {
    if (!riffler_pen_is_newer(report.sequence, last_.sequence)) {
      ++taken.old;
      return;
    }
    const auto step = static_cast<std::uint16_t>(report.sequence - last_.sequence);
    taken.lost += step - 1U;
    sample_.sequence += step;
    device_time_ += 1e-6 * static_cast<std::uint32_t>(report.time_us - last_.time_us);
    // The pen takes these sequence numbers as old, after those of another host: jump past all that are in transit.
    if (report.refused_count != last_.refused_count) sent_ = static_cast<std::uint16_t>(report.echo_sequence + 16);
  } else {
    // The pen stayed powered since the last report if its clock advanced as the host's did. Otherwise its counters
    // restarted, and its pose is unknown.
    const double ours = now - last_time_;
    const double its = 1e-6 * static_cast<std::uint32_t>(report.time_us - last_.time_us);
    if (!ever_heard_ || ours > 3600 || std::abs(its - ours) > kClockError) sample_.homed = false;
    device_time_ += ours;
    ++sample_.sequence;
    sent_ = static_cast<std::uint16_t>(report.echo_sequence + 16);
  }
  ++taken.reports;
  heard_ = ever_heard_ = true;
  last_ = report;
  last_time_ = now;
  place(report, now);
}

void RifflerModel::place(const riffler_pen_input& report, double now) noexcept {
  EncoderCounts raw{};
  std::copy(std::begin(report.counters), std::end(report.counters), raw.begin());
  if (home_asked_.exchange(false)) {
    kinematics_.home_at(raw, report.probe);
    sample_.homed = true;
  }
  speed_.add(raw, device_time_);
  sample_.dissipated += losses_.add(raw, device_time_);
  posture_ = kinematics_.posture(raw);
  const PenSpeed speed = kinematics_.speed(posture_, speed_.rates());
  sample_.pose = posture_.pose;
  sample_.counts = kinematics_.preset(raw);
  sample_.spin = kinematics_.probe_angle(report.probe);
  sample_.velocity = speed.twist.linear;
  sample_.turning = speed.twist.angular;
  sample_.stretch = check_grip(kinematics_, posture_).stretch;
  sample_.says_applied = true;
  std::copy(std::begin(report.applied), std::end(report.applied), sample_.currents.begin());
  sample_.applied = felt_wrench(kinematics_, posture_, joint_torques(geometry_, applied_wrench(report)));
  sample_.time = now;
  sample_.buttons = report.buttons;
  sample_.fault = report.state == RIFFLER_PEN_FAULT ? report.fault : 0U;
  sample_.late = sample_.fault != 0 && only_late(report.fault);
  sample_.powered = report.state != RIFFLER_PEN_BOOT && report.state != RIFFLER_PEN_FAULT;
}

/// Motor torques (N·mm) minus their part that is no wrench. Ramp, limits and age scale a whole command by one factor,
/// which follows from the currents.
MotorTorques RifflerModel::applied_wrench(const riffler_pen_input& report) const noexcept {
  const Command& command = commands_[report.echo_sequence % commands_.size()];
  double dot = 0, square = 0;
  for (std::size_t k = 0; k < kPenChannels; ++k) {
    const double told = command.all[k];
    dot += told * report.applied[k];
    square += told * told;
  }
  const bool known = command.sequence == report.echo_sequence && square > 0;
  const double part = known ? std::clamp(dot / square, 0.0, 1.0) : 0;
  MotorTorques out{};
  for (std::size_t k = 0; k < kPenChannels; ++k)
    out[k] = 1e-3 * report.applied[k] * geometry_.channels[k].torque_constant - part * command.own[k];
  return out;
}

bool RifflerModel::may_enable() const noexcept {
  // A pen that is not homed would push in a wrong direction.
  if (!heard_ || !sample_.homed) return false;
  const bool on = last_.state == RIFFLER_PEN_RAMP || last_.state == RIFFLER_PEN_ACTIVE;
  return on || (last_.state == RIFFLER_PEN_IDLE && (last_.flags & RIFFLER_PEN_FLAG_ARMED) != 0);
}

std::size_t RifflerModel::push(const haptics::SafeWrench& safe, double now, std::span<std::uint8_t> bytes) noexcept {
  if (!safe.open() || !may_enable()) return send({}, now, bytes);
  riffler_pen_output report{};
  report.enable = 1;
  const PenEffort effort = pen_effort(kinematics_, posture_, safe.wrench(), posture_.pose.tip);
  MotorTorques own = compensation_torques(geometry_, share_, posture_.angles, speed_.rates());
  for (double& torque : own) torque *= safe.gain();
  const MotorCommands currents = motor_currents(geometry_, motor_torques(geometry_, effort.torques), own);
  std::copy(currents.values.begin(), currents.values.end(), report.commands);
  const auto next = static_cast<std::uint16_t>(sent_ + 1);
  commands_[next % commands_.size()] = {currents.values, own, next};
  return send(report, now, bytes);
}

std::size_t RifflerModel::release(double now, std::span<std::uint8_t> bytes) noexcept {
  return send({}, now, bytes);
}

std::size_t RifflerModel::send(riffler_pen_output report, double now, std::span<std::uint8_t> bytes) noexcept {
  report.sequence = ++sent_;
  report.time_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(1e6 * std::max(now, 0.0)));
  riffler_pen_encode_output(&report, bytes.data());
  return RIFFLER_PEN_OUTPUT_SIZE;
}

}  // namespace riffler::pen
