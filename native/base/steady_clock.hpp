// Time for durations and deadlines.
#pragma once

#include <chrono>

namespace riffler::base {

/// s of the steady clock, which is the same one in all processes of a machine.
inline double steady_seconds() noexcept {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace riffler::base
