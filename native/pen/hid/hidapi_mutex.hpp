// The mutex for hidapi.
#pragma once

#include <mutex>
#include <new>

#include "base/forks.hpp"

namespace riffler::pen {

/// Held while calling hid_init, hid_enumerate and hid_open_path: they write hidapi's last error, a global variable,
/// without a lock, and concurrent calls would free it twice.
inline std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  // In a forked process, the thread that held it no longer exists to release it.
  [[maybe_unused]] static const bool free_in_forks = (base::run_in_forks([] { new (&mutex) std::mutex; }), true);
  return mutex;
}

}  // namespace riffler::pen
