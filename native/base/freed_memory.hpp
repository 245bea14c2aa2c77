// What becomes of memory that is freed.
#pragma once

namespace riffler::base {

/// Keeps freed arrays of up to 32 MB for the next ones of this process, where its C library allows that.
void reuse_freed_memory() noexcept;

}  // namespace riffler::base
