// The arms of Haply's Inverse Service: finding and opening them.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "riffler/pen/device.hpp"
#include "riffler/pen/found_device.hpp"
#include "riffler/pen/pen_options.hpp"

namespace riffler::pen {

inline constexpr const char* kHaplyKind = "haply";

/// The service's arms, as "haply:ID"; one entry that is not there if the service does not run or has none. Commands
/// nothing.
std::vector<FoundDevice> find_haply();

/// Opens the arm `id`; empty: the first that is free. Throws OpenError.
std::unique_ptr<Pen> open_haply(std::string_view id, const PenOptions& options);

}  // namespace riffler::pen
