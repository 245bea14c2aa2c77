// Machines described in TOML: docs/machines.md has the keys.
#pragma once

#include <string>
#include <string_view>

#include "nc/machine/machine.hpp"
#include "nc/options.hpp"

namespace riffler::nc {

/// A description as its file has it, with the options that its user gave: those that the file declares under [options],
/// and of every machine `tcp` (what X Y Z mean), `direction` (where the file says which way its tables turn),
/// `tool_length`, `limits_x` … `limits_c`, `rate_x` … `rate_c`, `max_rotary`. `file` stands in messages. Throws
/// FormatError naming file and line for what is wrong with the text, std::invalid_argument for options that are wrong
/// or missing.
MachineDescription describe_machine(std::string_view toml, const std::string& file, const std::string& name,
                                    OptionReader& options);

/// Its line for lists. FormatError as above.
std::string machine_summary(std::string_view toml, const std::string& file);

}  // namespace riffler::nc
