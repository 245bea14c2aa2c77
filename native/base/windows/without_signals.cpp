#include "base/without_signals.hpp"

namespace riffler::base {

/// Windows interrupts no system call.
struct WithoutSignals::Before {};

WithoutSignals::WithoutSignals() = default;

WithoutSignals::~WithoutSignals() = default;

}  // namespace riffler::base
