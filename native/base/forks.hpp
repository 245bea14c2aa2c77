// What a forked process does first.
#pragma once

namespace riffler::base {

/// Runs `work` in every process that this one is forked into, before anything else. Windows has no forks.
void run_in_forks(void (*work)());

}  // namespace riffler::base
