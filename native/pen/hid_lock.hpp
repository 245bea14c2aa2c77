// hidapi keeps its last error in one global variable that hid_init, hid_enumerate and hid_open_path write without a
// lock: two threads that call them free it twice. Whoever calls one of them holds this.
#pragma once

#include <mutex>

namespace riffler {

inline std::mutex& hidapi_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace riffler
