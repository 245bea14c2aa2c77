// Programs for Sinumerik 840D and 828D (Siemens, Programming Manual Fundamentals; Cycles), as CAM systems write them,
// to Program.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "riffler/nc/program.hpp"
#include "riffler/nc/read/read_options.hpp"

namespace riffler::nc {

/// docs/reading-nc.md lists what is supported; throws FormatError naming the line for everything else. Poses are in the
/// coordinates of the first work offset in which the program moves, without TRANS, ROT and tilted planes. `folder`:
/// searched for subprogram files; empty: none.
Program parse_sinumerik(std::string_view text, const std::string& file, const ReadOptions& options = {},
                        const std::filesystem::path& folder = {});

}  // namespace riffler::nc
