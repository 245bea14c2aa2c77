// The processors of this machine.
#pragma once

namespace riffler::base {

/// How many of them this process may use; 1 at least.
int usable_processors();

}  // namespace riffler::base
