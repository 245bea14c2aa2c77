// Heidenhain Klartext programs (TNC 640, User's Manual for Klartext Programming), as CAM systems write them, to
// Program.
#pragma once

#include <string>
#include <string_view>

#include "riffler/nc/program.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

/// docs/reading-nc.md lists what is supported; throws FormatError naming the line for everything else. Poses are in the
/// coordinates of the preset, without datum shifts and tilted planes.
Program parse_heidenhain(std::string_view text, const std::string& file, const ReadOptions& options = {});

}  // namespace riffler::nc
