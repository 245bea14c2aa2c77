// Report sizes from a HID report descriptor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace riffler::pen {

struct HidReports {
  bool numbered = false;  // every report begins with its number
  /// Sizes in bytes by report number, without the number itself; number 0 if reports are not numbered.
  std::array<std::uint16_t, 256> input{}, output{}, feature{};
  /// Page and usage of every top-level collection.
  std::vector<std::pair<std::uint16_t, std::uint16_t>> usages;

  bool has_usage(std::uint16_t page, std::uint16_t usage) const;
};

/// Device Class Definition for HID 1.11, 6.2.2. Throws std::invalid_argument naming the byte if the descriptor ends
/// within an item, or describes reports that no device can send.
HidReports parse_descriptor(std::span<const std::uint8_t> bytes);

}  // namespace riffler::pen
