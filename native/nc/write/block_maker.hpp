// From the rows of a program to the blocks of a machine: which joints, how many blocks between two rows, arcs, and the
// ways out of the material. Everything that a machine cannot do is found here.
#pragma once

#include <optional>

#include "nc/write/block_sink.hpp"
#include "riffler/nc/program.hpp"
#include "riffler/nc/write/write_options.hpp"

namespace riffler::nc {

struct BlockSettings {
  const Machine& machine;
  double tolerance;       ///< as in WriteOptions
  double axis_tolerance;  ///< as in WriteOptions
  /// mm, z of the tip above everything; not given: as high as the program goes.
  std::optional<double> safe_height;
  bool joints;  ///< whether blocks need joints; where not, poses are handed on as they are
  bool arcs;    ///< whether runs with one axis become lines and arcs
  bool motion;  ///< whether the report is to have the machine's motion
};

/// Hands the blocks of `program`, which has no via poses, to `sink`: every row is the end of a block, with more blocks
/// between two rows where the machine's axes, moving linearly, would leave the tolerances. RowError for the first row
/// that the machine cannot run; the blocks before it have been handed on. WriteReport::blocks stays 0.
WriteReport make_blocks(const Program& program, const BlockSettings& settings, BlockSink& sink);

}  // namespace riffler::nc
