#include "base/own_thread.hpp"

#include <windows.h>

#include <cstdint>

namespace riffler::base {

int process_number() noexcept {
  return static_cast<int>(GetCurrentProcessId());
}

double thread_seconds() noexcept {
  FILETIME created{}, ended{}, kernel{}, user{};
  if (!GetThreadTimes(GetCurrentThread(), &created, &ended, &kernel, &user)) return 0;
  const auto seconds = [](const FILETIME& t) {
    return 1e-7 * static_cast<double>(std::uint64_t{t.dwHighDateTime} << 32 | t.dwLowDateTime);
  };
  return seconds(kernel) + seconds(user);
}

}  // namespace riffler::base
