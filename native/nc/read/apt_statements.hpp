// Classifies APT statements by their effect on the tool path.
#pragma once

#include <string_view>

namespace riffler::nc {

/// Whether a statement has no effect on the tool path: texts, switches, notes of the CAM system.
bool apt_says_nothing(std::string_view major);

/// Whether a statement that is not supported moves the tool or shifts later moves, so that it must never be skipped.
bool apt_moves(std::string_view major);

}  // namespace riffler::nc
