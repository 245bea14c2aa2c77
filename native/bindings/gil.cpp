#include "bindings/gil.hpp"

#include <chrono>
#include <thread>

namespace riffler::bindings {

namespace {

[[noreturn]] void wait_for_the_end() noexcept {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

// The only thing thrown here is the unwinding by which Python ends the thread; it may be caught, but not ended.

NoGil::~NoGil() {
  try {
    PyEval_RestoreThread(state_);
  } catch (...) {
    wait_for_the_end();
  }
}

WithGil::WithGil() {
  if (!Py_IsInitialized()) wait_for_the_end();
  try {
    state_ = PyGILState_Ensure();
  } catch (...) {
    wait_for_the_end();
  }
}

}  // namespace riffler::bindings
