// Which branches of the library a run took, where it is compiled with -fsanitize-coverage=trace-pc (the preset fuzz).
#pragma once

#include <cstdint>

namespace riffler::fuzz {

/// Forgets what was taken.
void begin_coverage();
/// Whether a branch was taken, or was taken so often, as never before in this process. Always false without coverage.
bool is_new_coverage();
/// How many there were so far.
std::uint64_t covered();

}  // namespace riffler::fuzz
