// Branch coverage of a run, if the library is compiled with -fsanitize-coverage=trace-pc (the preset fuzz).
#pragma once

#include <cstdint>

namespace riffler::fuzz {

/// Clears the branches taken.
void begin_coverage();
/// Whether a branch was taken for the first time in this process, or more often than ever. Always false without
/// coverage.
bool is_new_coverage();
/// Number of times that coverage was new.
std::uint64_t covered();

}  // namespace riffler::fuzz
