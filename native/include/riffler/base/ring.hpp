// A queue between two threads, of fixed size, without locks.
#pragma once

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace riffler::base {

/// One thread puts, one other takes; neither waits for the other, and nothing is allocated after the start (Lamport,
/// "Proving the correctness of multiprocess programs", IEEE Trans. Software Engineering 3(2), 1977).
template <class T>
class Ring {
 public:
  /// Holds so many. std::invalid_argument for none.
  explicit Ring(std::size_t capacity) : slots_(capacity) {
    if (capacity == 0) throw std::invalid_argument("a ring must have room");
  }

  std::size_t capacity() const noexcept { return slots_.size(); }
  /// How many are in it at least, as the taker sees it, and at most, as the putter does.
  std::size_t size() const noexcept {
    return put_.load(std::memory_order_acquire) - taken_.load(std::memory_order_acquire);
  }

  /// By the one thread. False, and nothing is put, where it is full.
  bool put(const T& value) noexcept {
    const std::size_t n = put_.load(std::memory_order_relaxed);
    if (n - taken_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[n % slots_.size()] = value;
    put_.store(n + 1, std::memory_order_release);
    return true;
  }
  /// By the other. False where it is empty.
  bool take(T& value) noexcept {
    const std::size_t n = taken_.load(std::memory_order_relaxed);
    if (n == put_.load(std::memory_order_acquire)) return false;
    value = slots_[n % slots_.size()];
    taken_.store(n + 1, std::memory_order_release);
    return true;
  }

 private:
  std::vector<T> slots_;
  alignas(64) std::atomic<std::size_t> put_{0};
  alignas(64) std::atomic<std::size_t> taken_{0};
};

}  // namespace riffler::base
