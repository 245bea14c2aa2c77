// hidapi keeps its last error in one global variable that hid_init, hid_enumerate and hid_open_path write without a
// lock: two threads that call them free it twice. Whoever calls one of them holds this.
#pragma once

#include <pthread.h>

#include <mutex>
#include <new>

namespace riffler {

inline std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  // In a forked process the thread that held it is not there to let it go.
  [[maybe_unused]] static const int free_in_forks = pthread_atfork(nullptr, nullptr, [] { new (&mutex) std::mutex; });
  return mutex;
}

}  // namespace riffler
