// Reports and pens that the tests of device/ begin with.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "device/firmware/pen_firmware.h"
#include "stress/random.hpp"

namespace riffler::device {

using Bytes = std::vector<std::uint8_t>;
using Currents = std::array<std::int16_t, RIFFLER_PEN_JOINTS>;

inline Bytes encoded(const riffler_pen_input& report) {
  Bytes bytes(RIFFLER_PEN_INPUT_SIZE, 0xAA);
  riffler_pen_encode_input(&report, bytes.data());
  return bytes;
}
inline Bytes encoded(const riffler_pen_output& report) {
  Bytes bytes(RIFFLER_PEN_OUTPUT_SIZE, 0xAA);
  riffler_pen_encode_output(&report, bytes.data());
  return bytes;
}
inline Bytes encoded(const riffler_pen_identity& report) {
  Bytes bytes(RIFFLER_PEN_IDENTITY_SIZE, 0xAA);
  riffler_pen_encode_identity(&report, bytes.data());
  return bytes;
}
inline Bytes encoded(const riffler_pen_limits& report) {
  Bytes bytes(RIFFLER_PEN_LIMITS_SIZE, 0xAA);
  riffler_pen_encode_limits(&report, bytes.data());
  return bytes;
}
inline riffler_pen_result decode(const Bytes& bytes, riffler_pen_input& report) {
  return riffler_pen_decode_input(bytes.data(), bytes.size(), &report);
}
inline riffler_pen_result decode(const Bytes& bytes, riffler_pen_output& report) {
  return riffler_pen_decode_output(bytes.data(), bytes.size(), &report);
}
inline riffler_pen_result decode(const Bytes& bytes, riffler_pen_identity& report) {
  return riffler_pen_decode_identity(bytes.data(), bytes.size(), &report);
}
inline riffler_pen_result decode(const Bytes& bytes, riffler_pen_limits& report) {
  return riffler_pen_decode_limits(bytes.data(), bytes.size(), &report);
}

inline riffler_pen_config reference() {
  riffler_pen_config config;
  riffler_pen_reference_config(&config);
  return config;
}

/// A counter after so many counts; wraps.
inline std::int32_t moved(std::int32_t counter, int counts) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(counter) + static_cast<std::uint32_t>(counts));
}

/// Any report within its bounds.
inline riffler_pen_input random_input(stress::Random& random) {
  riffler_pen_input report{};
  const auto bits = [&] { return static_cast<std::uint32_t>(random.bits()); };
  report.state = static_cast<riffler_pen_state>(random.below(RIFFLER_PEN_STATES));
  report.sequence = static_cast<std::uint16_t>(bits());
  report.time_us = bits();
  for (std::int32_t& counter : report.counters) counter = static_cast<std::int32_t>(bits());
  report.probe = static_cast<std::int32_t>(bits());
  report.buttons = static_cast<std::uint16_t>(bits());
  report.flags = static_cast<std::uint16_t>(bits());
  const bool faulty = report.state == RIFFLER_PEN_FAULT;
  report.fault = static_cast<std::uint8_t>(faulty ? 1 + random.below(255) : 0);
  report.fault_joint = faulty && random.one_in(2) ? static_cast<std::uint8_t>(random.below(RIFFLER_PEN_JOINTS))
                                                  : std::uint8_t{RIFFLER_PEN_NO_JOINT};
  report.fault_count = static_cast<std::uint8_t>(bits());
  report.refused_count = static_cast<std::uint8_t>(bits());
  report.echo_sequence = static_cast<std::uint16_t>(bits());
  for (std::int16_t& current : report.applied) current = static_cast<std::int16_t>(bits());
  report.echo_time_us = bits();
  return report;
}
inline riffler_pen_output random_output(stress::Random& random) {
  riffler_pen_output report{};
  report.enable = random.below(2);
  report.sequence = static_cast<std::uint16_t>(random.bits());
  report.time_us = static_cast<std::uint32_t>(random.bits());
  for (std::int16_t& current : report.commands) current = static_cast<std::int16_t>(random.bits());
  return report;
}
inline riffler_pen_identity random_identity(stress::Random& random) {
  riffler_pen_identity report{};
  const auto fill = [&](char* name, int chars) {
    const int length = 1 + random.below(chars);
    for (int k = 0; k < length; ++k) name[k] = static_cast<char>(0x21 + random.below(0x5E));
  };
  report.major = RIFFLER_PEN_PROTOCOL_MAJOR;
  report.minor = static_cast<std::uint8_t>(random.bits());
  report.firmware = static_cast<std::uint16_t>(random.bits());
  fill(report.geometry, RIFFLER_PEN_GEOMETRY_CHARS);
  fill(report.serial, RIFFLER_PEN_SERIAL_CHARS);
  return report;
}
inline riffler_pen_limits random_limits(stress::Random& random) {
  riffler_pen_limits limits{};
  const auto in = [&](std::uint32_t least, std::uint32_t most) {
    return least + static_cast<std::uint32_t>(random.bits() % (std::uint64_t{most} - least + 1));
  };
  const auto in16 = [&](std::uint32_t least, std::uint32_t most) {
    return static_cast<std::uint16_t>(in(least, most));
  };
  for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) {
    limits.peak_ma[k] = in16(1, 32767);
    limits.continuous_ma[k] = in16(1, limits.peak_ma[k]);
  }
  limits.rate_ma_per_ms = in16(1, 65535);
  limits.thermal_ms = in16(1, 65535);
  limits.period_us = in(125, 100000);
  limits.watchdog_us = in(limits.period_us + 1, 1000000);
  limits.stale_us = in(limits.period_us, limits.watchdog_us - 1);
  limits.ramp_us = in(1, 60000000);
  limits.speed_counts_per_s = in(1, 100000000);
  limits.stall_ma = in16(1, *std::min_element(std::begin(limits.continuous_ma), std::end(limits.continuous_ma)));
  limits.stall_ms = in16(1, 65535);
  return limits;
}

/// A pen on a virtual clock with a host that counts its reports. Its sensors are those of a pen in a hand: counters
/// move, and currents are what the motors were commanded.
class Pen {
 public:
  explicit Pen(const riffler_pen_config& config = reference()) {
    riffler_pen_init(&pen, &config);
    sensors.ready = 1;
    for (std::int16_t& t : sensors.temperature_dc) t = 250;
  }

  /// One step; the hand trembles by a count.
  riffler_pen_drive step(std::uint32_t elapsed_us = 1000) {
    for (std::int32_t& counter : sensors.counters) counter = moved(counter, steps_ % 2 ? 1 : -1);
    ++steps_;
    return still_step(elapsed_us);
  }
  riffler_pen_drive still_step(std::uint32_t elapsed_us = 1000) {
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) sensors.current_ma[k] = drive.current_ma[k];
    return drive = riffler_pen_step(&pen, &sensors, elapsed_us);
  }
  riffler_pen_result send(bool enable, const Currents& commands = {}) {
    riffler_pen_output report{};
    report.enable = enable;
    report.sequence = ++sequence;
    for (int k = 0; k < RIFFLER_PEN_JOINTS; ++k) report.commands[k] = commands[k];
    const Bytes bytes = encoded(report);
    return riffler_pen_receive(&pen, bytes.data(), bytes.size());
  }
  /// A report and a step.
  riffler_pen_drive turn(bool enable, const Currents& commands = {}, std::uint32_t elapsed_us = 1000) {
    send(enable, commands);
    return step(elapsed_us);
  }
  /// Through boot and ramp, to the end of the rate limit.
  void activate(const Currents& commands = {}) {
    step();
    turn(false);
    const std::uint32_t turns = pen.config.limits.ramp_us / 1000 + 100;
    for (std::uint32_t k = 0; k < turns; ++k) turn(true, commands);
  }
  riffler_pen_state state() const { return pen.state; }
  int fault() const { return pen.fault; }
  Currents currents() const { return std::to_array(drive.current_ma); }

  riffler_pen_firmware pen;
  riffler_pen_sensors sensors{};
  riffler_pen_drive drive{};
  std::uint16_t sequence = 0;

 private:
  int steps_ = 0;
};

}  // namespace riffler::device
