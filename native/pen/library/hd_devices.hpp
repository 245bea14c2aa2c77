// The arms of 3D Systems: finding and opening them.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/pen/found_device.hpp"
#include "riffler/pen/pen_options.hpp"

namespace riffler::pen {

inline constexpr const char* kTouchKind = "touch";

/// The default arm, if the user has pointed to the library (RIFFLER_LIBHD); otherwise one entry that is not there and
/// says what is missing. Enables no force.
std::vector<FoundDevice> find_touch();

/// Opens the arm with that name in the maker's configuration; empty: the default one. Loads the library that
/// RIFFLER_LIBHD names, or that the system has. Throws OpenError.
std::unique_ptr<Pen> open_touch(std::string_view name, const PenOptions& options);

}  // namespace riffler::pen
