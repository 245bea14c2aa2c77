// Pens described in TOML; docs/pen-geometry.md lists the keys.
#pragma once

#include <string>
#include <string_view>

#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// Reads a description. Throws FormatError naming `file`, the line and what is expected there: for text that is not
/// TOML, a missing or unknown key, a wrong type, an impossible value, and for contradictory numbers: arm ends whose
/// distance at home is not the grip's length, a home outside the limits, a torque beyond the converter's range.
PenGeometry describe_pen(std::string_view toml, const std::string& file, const std::string& name);

/// The one-line summary for lists. Throws FormatError as above.
std::string pen_summary(std::string_view toml, const std::string& file);

}  // namespace riffler::pen
