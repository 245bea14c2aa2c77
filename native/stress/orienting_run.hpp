// Minutes of planning by feel with the simulated pen, as fast as the machine computes: whether it could run for ever.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace riffler::stress {

struct OrientingOptions {
  double seconds = 600;  ///< of the pen's time
  double warm = 30;      ///< s after which nothing may be asked of the system
  /// Calls of operator new in this thread so far, in programs that count them.
  std::function<long()> allocations = [] { return 0L; };
  std::function<void(double)> progress = [](double) {};  ///< share that is done
};

struct OrientingRun {
  std::vector<float> step_seconds;  ///< of processor time, of each step after the warm-up
  std::vector<double> resident;     ///< MB that the process held after each tenth of the run
  double account = 0;               ///< N·mm: the least that the account of passivity held
  double gained = 0;                ///< N·mm: the most that the motors gave in a contact and friction did not take
  double taken = 0;                 ///< N·mm that the motors took from the hand in all
  double deepest = 0;               ///< mm: true depth of the tool in part and clamp
  double greatest = 0;              ///< N·mm: of the torque that was sent
  std::uint64_t steps = 0, missed = 0, touched = 0;  ///< touched: shank or holder
  std::uint64_t understated = 0;                     ///< steps whose reported depth was less than the true one
  std::uint64_t set = 0, deleted = 0, refused = 0;
  std::uint64_t dropped = 0;      ///< ticks and presses that the queues had no room for
  std::uint64_t from_system = 0;  ///< blocks, in steps after the warm-up
  long allocations = 0;           ///< calls of operator new in steps after the warm-up
};

/// A hand turns and slides a tool with a wide shank along the edge of an L, past a clamp of dexels, into both, and its
/// buttons set and delete keys, from which the path is computed again.
OrientingRun orienting_run(const OrientingOptions& options);

}  // namespace riffler::stress
