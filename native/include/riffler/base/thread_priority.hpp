// How the system runs a thread that wants to be on time.
#pragma once

#include <string>

namespace riffler::base {

/// What a thread was granted that asked for real-time priority.
struct ThreadPriority {
  enum class By : unsigned char { Nobody, System, Rtkit };

  int level = 0;         ///< of SCHED_RR, 1 to 99: runs before all normal threads; 0: a normal thread
  By by = By::Nobody;    ///< who granted it: the system itself, or its service rtkit
  std::string text;      ///< for users: what was granted, or why nothing was
  std::string remedy{};  ///< for users: how to have it granted; empty if there is nothing to do

  bool real_time() const { return level > 0; }
};

}  // namespace riffler::base
