// Times a session's stroke through a block with rays in one direction or in three.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "riffler/geom/pose.hpp"

namespace riffler::bench {

/// A Ø20 ball moves through a block of 80 × 80 × 15 mm whose top is at z = 0, with a move of 1 ms between two poses.
struct DirectionOptions {
  std::vector<Pose> poses;
  std::string directions = "xyz";
  double pitch = 0.2;  ///< mm
  int shown = 33;      ///< steps between two requests of the display; 0: each step leaves a complete volume
};

struct DirectionRun {
  std::vector<double> seconds;            ///< processor time of every step, with its share of publishing
  double removed = 0;                     ///< mm³
  std::uint64_t tested = 0, changed = 0;  ///< rays
};

/// std::invalid_argument as Volume::block and MoveCarver.
DirectionRun direction_run(const DirectionOptions& options);

}  // namespace riffler::bench
