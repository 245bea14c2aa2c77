// APT cutter location files, as CAM systems write them (ISO 4343), to Program.
#pragma once

#include <string>
#include <string_view>

#include "riffler/nc/program.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

/// Reads GOTO, FROM and GODLTA with or without a tool axis, CIRCLE before a GOTO (counter-clockwise about its axis),
/// RAPID for the next move, UNITS, MULTAX, TLAXIS, FEDRAT, SPINDL, LOADTL and CUTTER; skips statements without motion.
/// Throws FormatError naming the line for everything else. Options: "chord_tolerance" and "unknown", as parse_nc.
Program parse_apt(std::string_view text, const std::string& file, const ReadOptions& options = {});

}  // namespace riffler::nc
