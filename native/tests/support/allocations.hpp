// How often a thread asks for memory.
#pragma once

#include <cstdint>

namespace riffler::test {

/// Calls of operator new so far in this thread.
std::uint64_t allocations();

}  // namespace riffler::test
