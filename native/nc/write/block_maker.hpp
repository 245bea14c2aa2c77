// From the rows of a program to the blocks of a machine: joints, subdivision between rows, arcs, and retracts. Detects
// everything that the machine cannot do.
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
  /// mm, z of the tip above everything; default: the highest point of the program.
  std::optional<double> safe_height;
  bool joints;  ///< whether blocks need joints; otherwise poses are passed on unchanged
  bool arcs;    ///< whether runs with a constant axis become lines and arcs
  bool motion;  ///< whether to record the machine's motion in the report
};

/// Passes the blocks of `program`, which has no via poses, to `sink`: every row ends a block, with more blocks between
/// two rows where the linearly moving axes would exceed the tolerances. Throws RowError for the first row that the
/// machine cannot run; the blocks before it have been passed on. WriteReport::blocks stays 0.
WriteReport make_blocks(const Program& program, const BlockSettings& settings, BlockSink& sink);

}  // namespace riffler::nc
