// Which HID devices are plugged in. Takes milliseconds, and allocates: never in the thread that drives a device.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace riffler::pen {

/// The texts are UTF-8, whatever the process's locale.
struct HidInfo {
  std::string path;  // what opens it: /dev/hidraw3
  std::uint16_t vendor = 0, product = 0;
  std::string maker, name, serial;
  int interface = -1;
  std::vector<std::pair<std::uint16_t, std::uint16_t>> usages;  // page and usage of every top collection

  bool has_usage(std::uint16_t page, std::uint16_t usage) const;
  /// "256f:c635"
  std::string id() const;
};

/// All of them, in the order of their paths' numbers. Throws std::runtime_error where the system's device list cannot
/// be read.
std::vector<HidInfo> list_hid();

/// What stays the same when a device is plugged in again, at another path perhaps.
struct HidAddress {
  std::string path;
  std::uint16_t vendor = 0, product = 0;
  std::string serial;
  int interface = -1;

  static HidAddress of(const HidInfo& info);
};

/// The device of that address among `found`: by maker, product and serial; of several the one at the same path, or the
/// first. Null if there is none.
const HidInfo* find_again(const std::vector<HidInfo>& found, const HidAddress& address);

}  // namespace riffler::pen
