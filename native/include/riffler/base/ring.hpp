// A lock-free queue of fixed size between two threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace riffler::base {

/// Single-producer, single-consumer queue: neither thread waits for the other, and only the constructor allocates
/// (Lamport, "Proving the correctness of multiprocess programs", IEEE Trans. Software Engineering 3(2), 1977).
template <class T>
class Ring {
 public:
  /// A queue for up to `capacity` values. Throws std::invalid_argument if it is 0.
  explicit Ring(std::size_t capacity) : slots_(capacity) {
    if (capacity == 0) throw std::invalid_argument("a ring's capacity must not be 0");
  }

  /// Maximum number of values.
  std::size_t capacity() const noexcept { return slots_.size(); }
  /// Number of values in the queue: a lower bound when the consumer calls it, an upper bound when the producer does.
  std::size_t size() const noexcept {
    return put_.load(std::memory_order_acquire) - taken_.load(std::memory_order_acquire);
  }

  /// Called by the producer. Returns false, and stores nothing, if the queue is full.
  bool put(const T& value) noexcept {
    const std::size_t n = put_.load(std::memory_order_relaxed);
    if (n - taken_.load(std::memory_order_acquire) == slots_.size()) return false;
    slots_[n % slots_.size()] = value;
    put_.store(n + 1, std::memory_order_release);
    return true;
  }
  /// Called by the consumer. Returns false if the queue is empty.
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
