// Every field of the four reports, by the header's offsets: what codec, descriptor and document are compared with.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "device/protocol/pen_protocol.h"

namespace riffler::device {

struct Field {
  std::string name;
  std::size_t offset;
  std::string type;  // as the document writes it: u8, u16, u32, i16, i32, char
  std::size_t count = 1;

  std::size_t width() const { return type.ends_with("32") ? 4 : type.ends_with("16") ? 2 : 1; }
  std::size_t size() const { return width() * count; }
};

struct Report {
  std::string name;
  int id;
  std::size_t size;
  std::vector<Field> fields;  // after the number
};

inline const std::vector<Report>& reports() {
  static const std::vector<Report> kReports = {
      {"Input",
       RIFFLER_PEN_INPUT_ID,
       RIFFLER_PEN_INPUT_SIZE,
       {{"state", RIFFLER_PEN_INPUT_STATE, "u8"},
        {"sequence", RIFFLER_PEN_INPUT_SEQUENCE, "u16"},
        {"time_us", RIFFLER_PEN_INPUT_TIME, "u32"},
        {"counters", RIFFLER_PEN_INPUT_COUNTERS, "i32", 6},
        {"probe", RIFFLER_PEN_INPUT_PROBE, "i32"},
        {"buttons", RIFFLER_PEN_INPUT_BUTTONS, "u16"},
        {"flags", RIFFLER_PEN_INPUT_FLAGS, "u16"},
        {"fault", RIFFLER_PEN_INPUT_FAULT, "u8"},
        {"fault_joint", RIFFLER_PEN_INPUT_FAULT_JOINT, "u8"},
        {"fault_count", RIFFLER_PEN_INPUT_FAULT_COUNT, "u8"},
        {"refused_count", RIFFLER_PEN_INPUT_REFUSED_COUNT, "u8"},
        {"echo_sequence", RIFFLER_PEN_INPUT_ECHO_SEQUENCE, "u16"},
        {"applied", RIFFLER_PEN_INPUT_APPLIED, "i16", 6},
        {"echo_time_us", RIFFLER_PEN_INPUT_ECHO_TIME, "u32"}}},
      {"Output",
       RIFFLER_PEN_OUTPUT_ID,
       RIFFLER_PEN_OUTPUT_SIZE,
       {{"flags", RIFFLER_PEN_OUTPUT_FLAGS, "u8"},
        {"sequence", RIFFLER_PEN_OUTPUT_SEQUENCE, "u16"},
        {"time_us", RIFFLER_PEN_OUTPUT_TIME, "u32"},
        {"commands", RIFFLER_PEN_OUTPUT_COMMANDS, "i16", 6}}},
      {"Identity",
       RIFFLER_PEN_IDENTITY_ID,
       RIFFLER_PEN_IDENTITY_SIZE,
       {{"magic", RIFFLER_PEN_IDENTITY_MAGIC, "char", 4},
        {"major", RIFFLER_PEN_IDENTITY_MAJOR, "u8"},
        {"minor", RIFFLER_PEN_IDENTITY_MINOR, "u8"},
        {"reserved", RIFFLER_PEN_IDENTITY_RESERVED, "u8"},
        {"firmware", RIFFLER_PEN_IDENTITY_FIRMWARE, "u16"},
        {"geometry", RIFFLER_PEN_IDENTITY_GEOMETRY, "char", RIFFLER_PEN_GEOMETRY_CHARS},
        {"serial", RIFFLER_PEN_IDENTITY_SERIAL, "char", RIFFLER_PEN_SERIAL_CHARS}}},
      {"Limits",
       RIFFLER_PEN_LIMITS_ID,
       RIFFLER_PEN_LIMITS_SIZE,
       {{"reserved", RIFFLER_PEN_LIMITS_RESERVED, "u8"},
        {"peak_ma", RIFFLER_PEN_LIMITS_PEAK, "u16", 6},
        {"continuous_ma", RIFFLER_PEN_LIMITS_CONTINUOUS, "u16", 6},
        {"rate_ma_per_ms", RIFFLER_PEN_LIMITS_RATE, "u16"},
        {"thermal_ms", RIFFLER_PEN_LIMITS_THERMAL, "u16"},
        {"period_us", RIFFLER_PEN_LIMITS_PERIOD, "u32"},
        {"stale_us", RIFFLER_PEN_LIMITS_STALE, "u32"},
        {"watchdog_us", RIFFLER_PEN_LIMITS_WATCHDOG, "u32"},
        {"ramp_us", RIFFLER_PEN_LIMITS_RAMP, "u32"},
        {"speed_counts_per_s", RIFFLER_PEN_LIMITS_SPEED, "u32"},
        {"stall_ma", RIFFLER_PEN_LIMITS_STALL_CURRENT, "u16"},
        {"stall_ms", RIFFLER_PEN_LIMITS_STALL_TIME, "u16"}}},
  };
  return kReports;
}

}  // namespace riffler::device
