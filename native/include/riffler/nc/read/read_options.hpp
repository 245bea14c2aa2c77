// How NC code is read.
#pragma once

#include <string>

#include "riffler/base/progress.hpp"
#include "riffler/nc/option_values.hpp"

namespace riffler::nc {

struct ReadOptions {
  std::string machine = "tcp";  ///< a name of machines(): what the axis words mean; its control says in which language
  /// Of the machine, and of the reader:
  /// "chord_tolerance" (mm, curves as chords; default 0.002); "axis_tolerance" (rad): where it is given, a feed move
  /// whose rotary axes, moving linearly, leave the great circle between its ends by more becomes several rows; without
  /// it every block is one row; "block_delete" (default true: lines that begin with / are passed over);
  /// "unknown": "error" (default) or "skip"; "subroutines": a folder of files name.ngc; "parameters": a file of
  /// LinuxCNC's parameters (work offsets, G28); "max_turns" of loops and calls (default 1e6), after which a program
  /// counts as endless.
  Options options;
  /// Called from the calling thread, some thousand lines apart, with the share of the text that has been read.
  Progress progress{};
};

}  // namespace riffler::nc
