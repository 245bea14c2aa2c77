// The tool's path as a machine executes it, with axes that move at constant rates within each block.
#pragma once

#include <cstddef>
#include <vector>

#include "riffler/geom/pose.hpp"

namespace riffler::nc {

/// A piece of a block that is a Motion. A block that turns rotary axes has several pieces.
struct MachineStep {
  std::size_t row;  ///< row of the program at which the block ends
  Pose from, to;
  bool rapid;
  bool first;  ///< starts at the machine's position after a tool change or at the start, straight to the row
};

/// The motion of a whole program in order. Rows without motion are left out.
using MachineMotion = std::vector<MachineStep>;

}  // namespace riffler::nc
