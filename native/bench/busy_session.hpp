// Measures how late the steps of a session are while other threads keep the machine busy, with the simulated pen in
// real time.
#pragma once

#include <vector>

#include "riffler/base/thread_priority.hpp"

namespace riffler::bench {

struct BusyOptions {
  double seconds = 5;
  int load = 4;           ///< threads that compute without pause
  bool real_time = true;  ///< the device's thread asks for real-time priority
};

struct BusyRun {
  std::vector<double> step;    ///< s from the start of each step to its end, of wall time
  std::vector<double> period;  ///< s from the start of a step to that of the next: 0.001 on an idle machine
  base::ThreadPriority priority;
};

/// Carves a block with a Ø6 ball that follows the pen's own motion, after the half second in which force ramps up.
BusyRun busy_session(const BusyOptions& options);

}  // namespace riffler::bench
