// APT statements by what they do to the tool's way.
#pragma once

#include <string_view>

namespace riffler::nc {

/// Whether a statement has no meaning for the tool's way: texts, switches, the CAM system's own notes.
bool apt_says_nothing(std::string_view major);

/// Whether a statement that is not read moves the tool or what follows, so that it is never skipped.
bool apt_moves(std::string_view major);

}  // namespace riffler::nc
