// Processor time, by which steps are measured: what others do on the machine does not count.
#pragma once

#include <ctime>

namespace riffler {

/// s that this thread has used.
inline double thread_seconds() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace riffler
