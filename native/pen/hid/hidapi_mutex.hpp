// One lock for hidapi.
#pragma once

#include <pthread.h>

#include <mutex>
#include <new>

namespace riffler::pen {

/// Held while one of hid_init, hid_enumerate and hid_open_path is called: they write hidapi's last error, one global
/// variable, without a lock, and two threads that call them free it twice.
inline std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  // In a forked process the thread that held it is not there to let it go.
  [[maybe_unused]] static const int free_in_forks = pthread_atfork(nullptr, nullptr, [] { new (&mutex) std::mutex; });
  return mutex;
}

}  // namespace riffler::pen
