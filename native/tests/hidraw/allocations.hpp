// How often a thread of this program has asked for memory, C code included.
#pragma once

namespace riffler::test {

/// By the calling thread, since it began.
long allocations() noexcept;

}  // namespace riffler::test
