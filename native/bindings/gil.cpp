#include "bindings/gil.hpp"

#include <chrono>
#include <thread>

#include "bindings/take_gil.h"

namespace riffler::bindings {

namespace {

[[noreturn]] void wait_for_the_end() {
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

}  // namespace

NoGil::~NoGil() {
  riffler_restore_thread(state_);
}

WithGil::WithGil() {
  if (!Py_IsInitialized()) wait_for_the_end();
  state_ = riffler_ensure_gil();
}

}  // namespace riffler::bindings
