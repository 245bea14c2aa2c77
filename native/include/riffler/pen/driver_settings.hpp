// Settings of a device's thread: reading and reconnecting.
#pragma once

namespace riffler::pen {

/// Time-outs and retries of a device's thread.
struct DriverSettings {
  double read_timeout = 0.01;  ///< s without a report after which the step runs with the old sample
  double late = 0.02;          ///< s that a step may take; the wrench of a later one is replaced by zero
  double silence = 0.25;       ///< s without a report after which a periodic device counts as disconnected
  double first_retry = 0.1;    ///< s before the first attempt to reconnect; doubled after every failure …
  double longest_retry = 2;    ///< … up to this
  double poll = 0.01;          ///< s between two polls for the device
  unsigned most_reads = 256;   ///< per tick: a flooding device cannot delay the step
  bool real_time = true;       ///< asks for real-time priority; false for a thread that does not wait for a clock

  /// Throws std::invalid_argument naming the field.
  void validate() const;
};

}  // namespace riffler::pen
