// The mutex for hidapi.
#pragma once

#include <pthread.h>

#include <mutex>
#include <new>

namespace riffler::pen {

/// Held while calling hid_init, hid_enumerate and hid_open_path: they write hidapi's last error, a global variable,
/// without a lock, and concurrent calls would free it twice.
inline std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  // In a forked process, the thread that held it no longer exists to release it.
  [[maybe_unused]] static const int free_in_forks = pthread_atfork(nullptr, nullptr, [] { new (&mutex) std::mutex; });
  return mutex;
}

}  // namespace riffler::pen
