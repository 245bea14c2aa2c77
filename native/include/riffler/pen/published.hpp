// A value that one thread writes and any thread reads, without locks.
#pragma once

#include <chrono>
#include <thread>

#include "riffler/base/sequence_lock.hpp"

namespace riffler::pen {

/// A trivially copyable value with one writer and any number of readers.
template <class T>
class Published {
 public:
  explicit Published(const T& value = T{}) noexcept { set(value); }

  /// Call it from one thread; never waits.
  void set(const T& value) noexcept { lock_.store(value, lock_.ticket() + 2); }
  /// Any thread. Copies again if the writer interfered. A real-time thread may have interrupted the writer on the same
  /// processor: only sleeping lets that finish.
  T get() const noexcept {
    T value;
    for (int tries = 1; lock_.load(value) == 0; ++tries)
      if (tries % kTries == 0) std::this_thread::sleep_for(std::chrono::microseconds(10));
    return value;
  }

 private:
  static constexpr int kTries = 1000;  // a copy takes nanoseconds
  base::SequenceLock<T> lock_;
};

}  // namespace riffler::pen
