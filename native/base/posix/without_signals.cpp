#include "base/without_signals.hpp"

#include <pthread.h>

#include <csignal>

namespace riffler::base {

struct WithoutSignals::Before {
  sigset_t blocked;
};

WithoutSignals::WithoutSignals() : before_(std::make_unique<Before>()) {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before_->blocked);
}

WithoutSignals::~WithoutSignals() {
  pthread_sigmask(SIG_SETMASK, &before_->blocked, nullptr);
}

}  // namespace riffler::base
