// An open HID device: messages are its input and output reports.
#pragma once

#include "pen/link/transport.hpp"

namespace riffler::pen {

/// An output report begins with its number, 0 if reports are not numbered; an input report only if they are.
class HidTransport : public Transport {
 public:
  /// Reads the feature report with number `bytes[0]` and returns its size in bytes; −1 if the device does not provide
  /// it.
  virtual int get_feature(std::span<std::uint8_t> bytes) noexcept = 0;
  /// The HID report descriptor.
  virtual std::span<const std::uint8_t> descriptor() const noexcept = 0;
};

}  // namespace riffler::pen
