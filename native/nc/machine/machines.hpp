// Finds a machine by its name or by the path of its description.
#pragma once

#include <memory>
#include <string_view>

#include "nc/machine/description.hpp"
#include "nc/machine/machine.hpp"
#include "nc/options.hpp"
#include "riffler/nc/machine/machine_list.hpp"

namespace riffler::nc {

/// `name`: from machines(), or the path of a .toml file. Options that the machine does not take remain in `options`.
/// Throws std::invalid_argument listing the known names, and errors of describe_machine.
std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options);

/// The texts of the same machine. Throws as make_machine.
MachineTexts texts_of_machine(std::string_view name);

}  // namespace riffler::nc
