// How often this thread has allocated: for what must not allocate at all.
#pragma once

namespace riffler::test {

/// Calls of operator new by this thread so far, from all code: allocations.cpp replaces it in the whole program.
long allocations();

}  // namespace riffler::test
