// Lists the HID devices that are plugged in. Takes milliseconds and allocates: not for a device's thread.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace riffler::pen {

/// One HID device. Texts are UTF-8 in every locale.
struct HidInfo {
  std::string path;  // path to open, e.g. /dev/hidraw3
  std::uint16_t vendor = 0, product = 0;
  std::string maker, name, serial;
  int interface = -1;
  std::vector<std::pair<std::uint16_t, std::uint16_t>> usages;  // page and usage of every top-level collection

  /// Whether a top-level collection has this usage.
  bool has_usage(std::uint16_t page, std::uint16_t usage) const;
  /// Vendor and product, for example "256f:c635".
  std::string id() const;
};

/// All HID devices, ordered by the numbers in their paths. Throws std::runtime_error if the system's device list cannot
/// be read.
std::vector<HidInfo> list_hid();

/// Identifies a device when it is plugged in again, possibly at another path.
struct HidAddress {
  std::string path;
  std::uint16_t vendor = 0, product = 0;
  std::string serial;
  int interface = -1;

  /// The address of a listed device.
  static HidAddress of(const HidInfo& info);
};

/// The device with that address among `found`: by vendor, product and serial number; of several the one at the same
/// path, otherwise the first. Null if there is none.
const HidInfo* find_again(const std::vector<HidInfo>& found, const HidAddress& address);

}  // namespace riffler::pen
