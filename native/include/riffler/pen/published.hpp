// A value that one thread writes and any thread reads, without locks.
#pragma once

#include "riffler/base/sequence_lock.hpp"

namespace riffler::pen {

/// A trivially copyable value with one writer and any number of readers.
template <class T>
class Published {
 public:
  explicit Published(const T& value = T{}) noexcept { set(value); }

  /// Call it from one thread; never waits.
  void set(const T& value) noexcept { lock_.store(value, lock_.ticket() + 2); }
  /// Any thread. Copies again if the writer interfered.
  T get() const noexcept {
    T value;
    while (lock_.load(value) == 0) {
    }
    return value;
  }

 private:
  base::SequenceLock<T> lock_;
};

}  // namespace riffler::pen
