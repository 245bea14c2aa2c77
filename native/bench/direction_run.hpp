// A stroke through a block with rays in one direction or in three, as a session makes it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace riffler::bench {

/// A Ø20 ball, sunk to its centre, on an inward spiral whose turns overlap, 0.5 mm a step.
struct DirectionOptions {
  std::string directions = "xyz";
  double pitch = 0.2;    ///< mm
  bool turning = false;  ///< the axis swings by 15°
  int steps = 400;
  int shown = 33;  ///< steps from one MoveCarver::publish to the next; 0: each step leaves a complete volume
};

struct DirectionRun {
  std::vector<double> seconds;            ///< of processor time, of every step with what is published after it
  double removed = 0;                     ///< mm³
  std::uint64_t tested = 0, changed = 0;  ///< rays
};

/// std::invalid_argument as Volume::block and MoveCarver.
DirectionRun direction_run(const DirectionOptions& options);

}  // namespace riffler::bench
