// How a stub finds its state.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>

namespace riffler::test {

/// The state in the file that the test has named. Without a test there is none, and the stub cannot work.
template <class State>
State& stub_state() {
  static State* const state = [] {
    const char* const name = std::getenv(State::kVariable);
    const int file = name == nullptr ? -1 : ::open(name, O_RDWR | O_CLOEXEC);
    void* const place = ::mmap(nullptr, sizeof(State), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (place == MAP_FAILED) std::abort();
    return static_cast<State*>(place);
  }();
  return *state;
}

}  // namespace riffler::test
