// A value that one thread writes and any thread reads, without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace riffler {

/// A sequence lock without fences (Boehm, "Can seqlocks get along with programming language memory models?", MSPC
/// 2012): the words themselves are atomic, so a reader that is overtaken copies a mixture, notices and copies again.
/// The writer never waits.
template <class T>
class Published {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit Published(const T& value = T{}) noexcept { set(value); }

  /// By one thread.
  void set(const T& value) noexcept {
    std::array<std::uint64_t, kWords> words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t ticket = ticket_.load(std::memory_order_relaxed);
    ticket_.store(ticket + 1, std::memory_order_relaxed);
    // Release: a reader that sees one of the words sees the odd ticket too.
    for (std::size_t k = 0; k < kWords; ++k) words_[k].store(words[k], std::memory_order_release);
    ticket_.store(ticket + 2, std::memory_order_release);
  }

  /// By any thread.
  T get() const noexcept {
    std::array<std::uint64_t, kWords> words{};
    for (;;) {
      const std::uint64_t before = ticket_.load(std::memory_order_acquire);
      // Acquire: none of these moves behind the second look at the ticket.
      for (std::size_t k = 0; k < kWords; ++k) words[k] = words_[k].load(std::memory_order_acquire);
      if (before % 2 == 0 && ticket_.load(std::memory_order_relaxed) == before) break;
    }
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + 7) / 8;
  std::atomic<std::uint64_t> ticket_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace riffler
