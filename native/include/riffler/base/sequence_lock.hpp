// A value that one thread writes and others read without locks. The writer never waits.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace riffler::base {

/// A sequence lock without fences (Boehm, "Can seqlocks get along with programming language memory models?", MSPC
/// 2012). The data words themselves are atomic, so a reader that the writer overtakes copies a mix of old and new
/// words, and detects it by the ticket.
template <class T>
class SequenceLock {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// Called by the one writer. `ticket` is even and greater than the previous one.
  void store(const T& value, std::uint64_t ticket) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof value);
    ticket_.store(ticket - 1, std::memory_order_relaxed);
    // Release: a reader that sees any of the new words also sees the odd ticket.
    for (std::size_t k = 0; k < kWords; ++k) words_[k].store(words[k], std::memory_order_release);
    ticket_.store(ticket, std::memory_order_release);
  }
  /// Called by any thread. Copies the value and returns its ticket. Returns 0 and leaves `value` unchanged before the
  /// first store, or if the writer interfered.
  std::uint64_t load(T& value) const noexcept {
    const std::uint64_t ticket = ticket_.load(std::memory_order_acquire);
    if (ticket % 2 != 0 || ticket == 0) return 0;
    // Acquire: no load of a word moves past the second load of the ticket.
    std::array<std::uint64_t, kWords> words;
    for (std::size_t k = 0; k < kWords; ++k) words[k] = words_[k].load(std::memory_order_acquire);
    if (ticket_.load(std::memory_order_relaxed) != ticket) return 0;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return ticket;
  }
  /// Ticket of the newest value. Called by the writer.
  std::uint64_t ticket() const noexcept { return ticket_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  std::atomic<std::uint64_t> ticket_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace riffler::base
