// NC code (RS-274) → Program.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "nc/options.hpp"
#include "nc/program.hpp"

namespace riffler {

struct ReadOptions {
  std::string machine = "tcp";  ///< a name of machines(): what the axis words mean
  /// Of the machine, and of the reader: "chord_tolerance" (mm, arcs as chords; default 0.002); "axis_tolerance" (rad):
  /// where it is given, a feed move whose rotary axes, moving linearly, leave the great circle between its ends by more
  /// becomes several rows; without it every block is one row.
  Options options;
};

/// One row per move end; rows of one block have its line. Coordinates that no block has named are 0. `file` (base name)
/// stands in messages. FormatError naming the line for everything that is not understood in full; nothing is skipped.
/// Reads G0–G4, G17–G19, G20/21, G40, G43/G43.4/G49, G54, G61/G61.1/G64, G80, G90/91, G90.1/91.1, G93/94, G98/99,
/// M0–M9, M30, T, S, F, H, N, and O as the number of the program.
Program parse_nc(std::string_view text, const std::string& file, const ReadOptions& options = {});

Program read_nc(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace riffler
