// Report descriptors of devices that tests stand in for. Those of pucks and boards are written after the HID class
// definition, with the reports that the devices have.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/protocol/pen_protocol.h"
#include "riffler/pen/hid/hid_list.hpp"

namespace riffler::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes pen_descriptor() {
  return {riffler_pen_descriptor, riffler_pen_descriptor + riffler_pen_descriptor_size};
}

/// Six axes of 16 bits, −350 … 350, in one report or in two; two buttons.
inline Bytes puck_descriptor(bool joined) {
  const Bytes range{0x16, 0xA2, 0xFE, 0x26, 0x5E, 0x01, 0x75, 16};
  Bytes out{0x05, 0x01, 0x09, 0x08, 0xA1, 0x01, 0xA1, 0x00, 0x85, 1};
  const auto add = [&](const Bytes& more) {
    for (const std::uint8_t b : more) out.push_back(b);
  };
  add(range);
  add({0x09, 0x30, 0x09, 0x31, 0x09, 0x32});
  if (!joined) add({0x95, 3, 0x81, 0x06, 0xC0, 0xA1, 0x00, 0x85, 2});
  add({0x09, 0x33, 0x09, 0x34, 0x09, 0x35, 0x95, static_cast<std::uint8_t>(joined ? 6 : 3), 0x81, 0x06, 0xC0});
  add({0xA1, 0x02, 0x85, 3, 0x05, 0x09, 0x19, 1, 0x29, 2, 0x15, 0, 0x25, 1, 0x75, 1, 0x95, 2, 0x81, 0x02});
  add({0x95, 14, 0x81, 0x03, 0xC0, 0xC0});
  return out;
}

/// "Raw HID" of Teensy boards: 64 bytes in both directions, no report numbers.
inline Bytes teensy_descriptor() {
  return {0x06, 0xAB, 0xFF, 0x0A, 0x00, 0x02, 0xA1, 0x01, 0x75, 8,    0x15, 0x00, 0x26, 0xFF,
          0x00, 0x95, 64,   0x09, 0x01, 0x81, 0x02, 0x95, 64,   0x09, 0x02, 0x91, 0x02, 0xC0};
}

inline pen::HidInfo pen_info() {
  pen::HidInfo info;
  info.path = "/dev/hidraw0";
  info.vendor = RIFFLER_PEN_VENDOR_ID, info.product = RIFFLER_PEN_PRODUCT_ID;
  info.name = RIFFLER_PEN_PRODUCT;
  return info;
}

inline pen::HidInfo puck_info(std::uint16_t vendor = 0x256F, std::uint16_t product = 0xC635) {
  pen::HidInfo info;
  info.path = "/dev/hidraw1";
  info.vendor = vendor, info.product = product;
  return info;
}

/// Sixteen bits each, little-endian.
inline void put_values(Bytes& bytes, std::size_t at, const std::vector<int>& values) {
  for (const int v : values) {
    bytes[at++] = static_cast<std::uint8_t>(v & 0xFF);
    bytes[at++] = static_cast<std::uint8_t>((v >> 8) & 0xFF);
  }
}

/// Report 1 or 2 of a puck, or both together with six values.
inline Bytes puck_report(std::uint8_t number, const std::vector<int>& values) {
  Bytes bytes(1 + 2 * values.size(), number);
  put_values(bytes, 1, values);
  return bytes;
}

/// A report of WoodenHaptics and Polhem: six counters and a flag, in 64 bytes.
inline Bytes polhem_report(const std::vector<int>& values) {
  Bytes bytes(64);
  put_values(bytes, 0, values);
  return bytes;
}

}  // namespace riffler::test
