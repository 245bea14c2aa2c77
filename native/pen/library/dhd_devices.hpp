// The arms of Force Dimension and Novint: finding and opening them.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/pen/found_device.hpp"
#include "riffler/pen/pen_options.hpp"

namespace riffler::pen {

inline constexpr const char* kForceDimensionKind = "force-dimension";

/// The arms as "force-dimension:SERIAL", if the user has pointed to the library (RIFFLER_LIBDHD); otherwise one entry
/// that is not there and says what is missing. Enables no force.
std::vector<FoundDevice> find_force_dimension();

/// Opens the arm with that serial number; empty: the first that opens. Loads the library that RIFFLER_LIBDHD names, or
/// that the system has. Throws OpenError.
std::unique_ptr<Pen> open_force_dimension(std::string_view serial, const PenOptions& options);

}  // namespace riffler::pen
