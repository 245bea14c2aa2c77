// What the driver uses: a transport for reports, and a clock. Tests replace both, so that any order of events can be
// played without hardware and without waiting.
#pragma once

#include <cstdint>
#include <span>

namespace riffler::pen {

/// Reports of a full-speed device have at most 64 bytes, 65 with a number; a serial line in between may deliver several
/// at once.
inline constexpr std::size_t kLongestRead = 1024;

/// An open device. Used by one thread at a time. The destructor closes it.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Reads one input report and returns its size in bytes; 0 if none arrived within `seconds` (0: do not wait), −1 if
  /// the device is gone.
  virtual int read(std::span<std::uint8_t> bytes, double seconds) noexcept = 0;
  /// Writes an output report that begins with its number (0 if reports are not numbered). False if the device is gone.
  virtual bool write(std::span<const std::uint8_t> bytes) noexcept = 0;
  /// Reads the feature report with number `bytes[0]` and returns its size in bytes; −1 if the device does not provide
  /// it.
  virtual int get_feature(std::span<std::uint8_t> bytes) noexcept = 0;
  /// The HID report descriptor.
  virtual std::span<const std::uint8_t> descriptor() const noexcept = 0;
};

/// A monotonic clock in seconds since some start.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() noexcept = 0;
  /// May return early.
  virtual void wait(double seconds) noexcept = 0;
};

}  // namespace riffler::pen
