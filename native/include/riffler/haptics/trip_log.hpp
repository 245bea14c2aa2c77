// The last trips: the haptic loop writes them, any thread reads them without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

#include "riffler/base/sequence_lock.hpp"
#include "riffler/haptics/states.hpp"

namespace riffler::haptics {

/// One trip or stop of the force.
struct Trip {
  double time;       ///< s since the Safety object was created
  ForceState state;  ///< before the trip
  Cause cause;
  double value;  ///< measured value; its meaning is given at Cause
};

/// A ring buffer: one thread writes, any may read. Neither waits for the other or allocates.
class TripLog {
 public:
  static constexpr std::size_t kCapacity = 256;

  /// Appends a trip; overwrites the oldest when full. By the writing thread.
  void add(const Trip& trip);
  /// Number of trips so far. The last kCapacity of them are stored.
  std::uint64_t count() const { return count_.load(std::memory_order_acquire); }
  /// Copies trips from number `from` on into `out`, oldest first, skipping overwritten ones. Returns the number copied
  /// and sets `from` to the number of the first trip not read yet.
  std::size_t read(std::uint64_t& from, std::span<Trip> out) const;

 private:
  std::array<base::SequenceLock<Trip>, kCapacity> slots_{};  // trip n has the ticket 2 n + 2
  std::atomic<std::uint64_t> count_{0};
};

}  // namespace riffler::haptics
