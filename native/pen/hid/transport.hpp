// What the driver drives: a way to exchange reports, and a clock. Both have a fake in the tests, so that every order of
// events can be played without hardware and without waiting.
#pragma once

#include <cstdint>
#include <span>

namespace riffler::pen {

/// The longest report of a full-speed device is 64 bytes, 65 with a number; a serial line in between may deliver
/// several at once.
inline constexpr std::size_t kLongestRead = 1024;

/// An open device. Used by one thread at a time. Closed by its destructor.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Bytes of one input report; 0 where none came within `seconds` (0: what is there now), −1 where the device is gone.
  virtual int read(std::span<std::uint8_t> bytes, double seconds) noexcept = 0;
  /// An output report, its number first (0 where the device numbers none). False where the device is gone.
  virtual bool write(std::span<const std::uint8_t> bytes) noexcept = 0;
  /// Bytes of the feature report that `bytes[0]` numbers; −1 where the device does not give it.
  virtual int get_feature(std::span<std::uint8_t> bytes) noexcept = 0;
  /// The HID report descriptor.
  virtual std::span<const std::uint8_t> descriptor() const noexcept = 0;
};

/// Seconds since some start; never falls.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual double now() noexcept = 0;
  /// May return early.
  virtual void wait(double seconds) noexcept = 0;
};

}  // namespace riffler::pen
