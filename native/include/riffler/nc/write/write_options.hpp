// Options for writing NC code, and the report that comes with the text.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "riffler/nc/machine/machine_motion.hpp"
#include "riffler/nc/option_values.hpp"

namespace riffler::nc {

/// Options of to_nc and write_nc.
struct WriteOptions {
  std::string post = "tcp";         ///< name from machines(), or path of a machine description
  double tolerance = 0.01;          ///< mm, distance of the tip from the line between two rows; at least 2e-5
  double axis_tolerance = 0.00175;  ///< rad, angle of the axis to the great circle between two rows; at least 1e-7
  Options options;                  ///< options of the machine and the post
  bool motion = false;              ///< whether to fill WriteReport::motion
};

/// Neighbouring rows in which the rotary axes turn much further than the tool: near the singular direction.
struct PolePassage {
  std::size_t first, last;
  double tool, rotary;  ///< deg
  double slowed;        ///< largest ratio of a block's time to the time at its feed; 1: not slowed
};

/// Blocks, slowed blocks, retracts and pole passages of a written program.
struct WriteReport {
  std::size_t blocks = 0;            ///< blocks with a motion
  std::size_t slowed = 0;            ///< blocks slowed by the rate limit of an axis
  std::vector<std::size_t> rewinds;  ///< rows during which the tool retracts to unwind rotary axes
  std::vector<PolePassage> passages;
  MachineMotion motion;  ///< filled if WriteOptions::motion is set
};

}  // namespace riffler::nc
