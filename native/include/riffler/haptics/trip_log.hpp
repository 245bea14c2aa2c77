// The last trips, written by the haptic loop and read by anybody else, without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "riffler/base/sequence_lock.hpp"
#include "riffler/haptics/states.hpp"

namespace riffler::haptics {

struct Trip {
  double time;       ///< s since the machine was made
  ForceState state;  ///< in which it happened
  Cause cause;
  double value;  ///< what the cause is about: see Cause
};

/// A ring: one thread writes, any may read. Neither waits for the other or allocates.
class TripLog {
 public:
  static constexpr std::size_t kCapacity = 256;

  void add(const Trip& trip);
  /// Trips so far; the last kCapacity of them are held.
  std::uint64_t count() const { return count_.load(std::memory_order_acquire); }
  /// Copies trips from number `from` on, oldest first, skipping those that are no longer held. Returns how many were
  /// copied; `from` becomes the number of the first that was not looked at.
  std::size_t read(std::uint64_t& from, std::span<Trip> out) const;

 private:
  std::array<base::SequenceLock<Trip>, kCapacity> slots_{};  // trip n has the ticket 2 n + 2
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace riffler::haptics
