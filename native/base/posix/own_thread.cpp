#include "base/own_thread.hpp"

#include <unistd.h>

#include <ctime>

namespace riffler::base {

int process_number() noexcept {
  return getpid();
}

double thread_seconds() noexcept {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace riffler::base
