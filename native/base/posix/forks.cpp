#include "base/forks.hpp"

#include <pthread.h>

namespace riffler::base {

void run_in_forks(void (*work)()) {
  pthread_atfork(nullptr, nullptr, work);
}

}  // namespace riffler::base
