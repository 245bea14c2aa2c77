// What the driver uses: a transport for messages, and a clock. Tests replace both, so that any order of events can be
// played without hardware and without waiting.
#pragma once

#include <cstdint>
#include <span>

namespace riffler::pen {

/// An open device, service or library. Used by one thread at a time. The destructor closes it.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Reads one message and returns its size in bytes; 0 if none arrived within `seconds` (0: do not wait), −1 if the
  /// device is gone.
  virtual int read(std::span<std::uint8_t> bytes, double seconds) noexcept = 0;
  /// Writes one message. False if the device is gone.
  virtual bool write(std::span<const std::uint8_t> bytes) noexcept = 0;
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
