// What programs are written for, and what comes of it beside the text.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "riffler/nc/machine/machine_motion.hpp"
#include "riffler/nc/option_values.hpp"

namespace riffler::nc {

struct WriteOptions {
  std::string post = "tcp";         ///< a name of machines(), or the path of a description
  double tolerance = 0.01;          ///< mm, tip between two rows to the straight line; at least 2e-5
  double axis_tolerance = 0.00175;  ///< rad, axis between two rows to the great circle; at least 1e-7
  Options options;                  ///< of the machine and of the post
  bool motion = false;              ///< whether the report is to have the machine's motion
};

/// Neighbouring rows in which the rotary axes turn much more than the tool does: near the singular direction.
struct PolePassage {
  std::size_t first, last;
  double tool, rotary;  ///< deg
  double slowed;        ///< the longest time of a block by what its feed would take; 1: nothing slowed
};

struct WriteReport {
  std::size_t blocks = 0;            ///< with a motion
  std::size_t slowed = 0;            ///< of them longer than their feed asks, for an axis's rate
  std::vector<std::size_t> rewinds;  ///< rows before whose ends the tool leaves the material to turn axes back
  std::vector<PolePassage> passages;
  MachineMotion motion;  ///< where it was asked for
};

}  // namespace riffler::nc
