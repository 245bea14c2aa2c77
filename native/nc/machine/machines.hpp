// A machine by its name or by the path of its description.
#pragma once

#include <memory>
#include <string_view>

#include "nc/machine/machine.hpp"
#include "nc/options.hpp"
#include "riffler/nc/machine/machine_list.hpp"

namespace riffler::nc {

/// `name` is one of machines(), or the path of a .toml file. Options that the machine does not take stay in `options`.
/// Throws std::invalid_argument that lists the known ones, and what describe_machine throws.
std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options);

}  // namespace riffler::nc
