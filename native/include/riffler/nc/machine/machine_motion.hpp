// The tool's way as a machine makes it: its axes move evenly from block to block.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/geom/pose.hpp"

namespace riffler::nc {

/// A stretch of a block that is a Motion: where rotary axes turn, blocks are several.
struct MachineStep {
  std::size_t row;  ///< of the program, to whose end the block leads
  Pose from, to;
  bool rapid;
  bool first;  ///< from where the machine is after a tool change or at the start, straight down to the row
};

/// The whole of a program, in its order; rows that do not move are left out.
using MachineMotion = std::vector<MachineStep>;

}  // namespace riffler::nc
