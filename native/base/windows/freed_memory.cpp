#include "base/freed_memory.hpp"

namespace riffler::base {

/// The heap of Windows decides by itself.
void reuse_freed_memory() noexcept {}

}  // namespace riffler::base
