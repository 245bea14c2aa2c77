// What the user sets in the environment, in UTF-8.
#pragma once

#include <optional>
#include <string>

namespace riffler::base {

/// Value of a variable; none if it is not set. It is the current one, also where Python has changed it: on Windows,
/// the C library of this module has a copy that does not change.
std::optional<std::string> environment(const char* name);

}  // namespace riffler::base
