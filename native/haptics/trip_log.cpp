#include "haptics/trip_log.hpp"

#include <bit>

namespace riffler {

void TripLog::add(const Trip& trip) {
  const std::uint64_t number = count_.load(std::memory_order_relaxed);
  Slot& slot = slots_[number % kCapacity];
  const std::array<std::uint64_t, 3> words{
      std::bit_cast<std::uint64_t>(trip.time), std::bit_cast<std::uint64_t>(trip.value),
      static_cast<std::uint64_t>(trip.state) << 8 | static_cast<std::uint64_t>(trip.cause)};
  slot.ticket.store(2 * number + 1, std::memory_order_relaxed);
  // Each after the odd ticket: whoever sees one of them sees that.
  for (std::size_t k = 0; k < words.size(); ++k) slot.words[k].store(words[k], std::memory_order_release);
  slot.ticket.store(2 * number + 2, std::memory_order_release);
  count_.store(number + 1, std::memory_order_release);
}

std::size_t TripLog::read(std::uint64_t& from, std::span<Trip> out) const {
  const std::uint64_t end = count();
  if (end > kCapacity && from < end - kCapacity) from = end - kCapacity;
  std::size_t copied = 0;
  for (; from < end && copied < out.size(); ++from) {
    const Slot& slot = slots_[from % kCapacity];
    if (slot.ticket.load(std::memory_order_acquire) != 2 * from + 2) continue;
    std::array<std::uint64_t, 3> words;
    for (std::size_t k = 0; k < words.size(); ++k) words[k] = slot.words[k].load(std::memory_order_acquire);
    if (slot.ticket.load(std::memory_order_relaxed) != 2 * from + 2) continue;
    out[copied++] = {std::bit_cast<double>(words[0]), static_cast<ForceState>(words[2] >> 8),
                     static_cast<Cause>(words[2] & 0xff), std::bit_cast<double>(words[1])};
  }
  return copied;
}

}  // namespace riffler
