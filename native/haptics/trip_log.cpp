#include "riffler/haptics/trip_log.hpp"

namespace riffler::haptics {

void TripLog::add(const Trip& trip) {
  const std::uint64_t number = count_.load(std::memory_order_relaxed);
  slots_[number % kCapacity].store(trip, 2 * number + 2);
  count_.store(number + 1, std::memory_order_release);
}

std::size_t TripLog::read(std::uint64_t& from, std::span<Trip> out) const {
  const std::uint64_t end = count();
  if (end > kCapacity && from < end - kCapacity) from = end - kCapacity;
  std::size_t copied = 0;
  for (; from < end && copied < out.size(); ++from)
    if (Trip trip; slots_[from % kCapacity].load(trip) == 2 * from + 2) out[copied++] = trip;
  return copied;
}

}  // namespace riffler::haptics
