// Pens described in TOML: docs/pen-geometry.md has the keys.
#pragma once

#include <string>
#include <string_view>

#include "riffler/pen/arms/geometry.hpp"

namespace riffler::pen {

/// Throws FormatError naming `file`, the line and what is expected there: for what is not TOML, a key that is missing,
/// unknown or of the wrong type, a value that cannot be, and for a pen whose numbers contradict each other: ends that
/// are not the grip's length apart at home, a home outside the limits, a torque beyond the converter's range.
PenGeometry describe_pen(std::string_view toml, const std::string& file, const std::string& name);

/// Its line for lists. FormatError as above.
std::string pen_summary(std::string_view toml, const std::string& file);

}  // namespace riffler::pen
