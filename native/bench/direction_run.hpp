// A stroke through a block with rays in one direction or in three, as a session makes it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"

namespace riffler::bench {

/// A Ø20 ball through a block of 80 × 80 × 15 mm whose top is at z = 0, a move of 1 ms from each pose to the next.
struct DirectionOptions {
  std::vector<Pose> poses;
  std::string directions = "xyz";
  double pitch = 0.2;  ///< mm
  int shown = 33;      ///< steps from one look of the display to the next; 0: each step leaves a complete volume
};

struct DirectionRun {
  std::vector<double> seconds;            ///< of processor time, of every step with its part of what is published
  double removed = 0;                     ///< mm³
  std::uint64_t tested = 0, changed = 0;  ///< rays
};

/// std::invalid_argument as Volume::block and MoveCarver.
DirectionRun direction_run(const DirectionOptions& options);

}  // namespace riffler::bench
