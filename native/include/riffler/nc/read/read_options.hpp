// Options for reading NC code.
#pragma once

#include <string>

#include "riffler/base/progress.hpp"
#include "riffler/nc/option_values.hpp"

namespace riffler::nc {

/// Options of parse_nc, read_nc and NcStream.
struct ReadOptions {
  std::string machine = "tcp";  ///< name from machines(): defines axis words and language
  /// Options of the machine, and of the reader:
  /// "chord_tolerance" (mm, default 0.002): of chords that replace curves.
  /// "axis_tolerance" (rad): if given, a feed move whose linearly moving rotary axes leave the great circle between its
  /// ends by more is split into several rows; by default every block is one row.
  /// "block_delete" (default true): skip lines that begin with /.
  /// "unknown": "error" (default) or "skip".
  /// "subroutines": a folder of files name.ngc.
  /// "parameters": a LinuxCNC parameter file (work offsets, G28).
  /// "max_turns" (default 1e6): number of loops and calls after which a program counts as endless.
  Options options;
  /// Called from the calling thread every few thousand lines with the fraction of the text read so far, 0 to 1.
  Progress progress{};
};

}  // namespace riffler::nc
