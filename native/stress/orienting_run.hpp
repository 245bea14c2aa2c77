// Plans by feel with the simulated pen for minutes, as fast as the machine computes, and checks that it could run for
// ever.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace riffler::stress {

struct OrientingOptions {
  double seconds = 600;  ///< of the pen's time
  double warm = 30;      ///< s after which steps may no longer allocate
  /// Calls of operator new in this thread so far, in programs that count them.
  std::function<long()> allocations = [] { return 0L; };
  std::function<void(double)> progress = [](double) {};  ///< share that is done
};

struct OrientingRun {
  std::vector<float> step_seconds;  ///< of processor time, of each step after the warm-up
  std::vector<double> resident;     ///< MB of resident memory after each tenth of the run
  double account = 0;               ///< N·mm: smallest value of the passivity account
  double gained = 0;                ///< N·mm: largest energy that motors gave in a contact, less losses by friction
  double taken = 0;                 ///< N·mm: total energy that the motors took from the hand
  double deepest = 0;               ///< mm: true depth of the tool in part and clamp
  double greatest = 0;              ///< N·mm: largest torque sent
  std::uint64_t steps = 0, missed = 0, touched = 0;  ///< touched: shank or holder
  std::uint64_t understated = 0;                     ///< steps whose reported depth was less than the true one
  std::uint64_t set = 0, deleted = 0, refused = 0;
  std::uint64_t dropped = 0;      ///< ticks and presses dropped because a queue was full
  std::uint64_t from_system = 0;  ///< memory blocks taken from the system in steps after the warm-up
  long allocations = 0;           ///< calls of operator new in steps after the warm-up
};

/// A hand turns and slides a tool with a wide shank along the edge of an L and past a clamp of dexels, and pushes it
/// into both. Its buttons set and delete keys, after which the path is computed again.
OrientingRun orienting_run(const OrientingOptions& options);

}  // namespace riffler::stress
