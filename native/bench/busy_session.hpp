// A session with the simulated pen in real time while other threads keep the machine busy: how late its steps are.
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
  std::vector<double> step;    ///< s from the start of each step to its end, by the clock on the wall
  std::vector<double> period;  ///< s from the start of a step to that of the next: 0.001 on an idle machine
  base::ThreadPriority priority;
};

/// A Ø6 ball carves a block by the pen's own motion, after the half second in which force ramps up.
BusyRun busy_session(const BusyOptions& options);

}  // namespace riffler::bench
