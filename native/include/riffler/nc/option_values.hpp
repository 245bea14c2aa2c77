// Named options of machines and posts, as callers pass them.
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace riffler::nc {

using OptionValue = std::variant<bool, double, std::string, std::vector<double>>;
using Options = std::map<std::string, OptionValue>;

}  // namespace riffler::nc
