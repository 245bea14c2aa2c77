// Machines described in TOML; docs/machines.md lists the keys.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "nc/machine/machine.hpp"
#include "nc/options.hpp"

namespace riffler::nc {

/// Reads a description and applies the user's options: those declared under [options], and for every machine `tcp` (the
/// meaning of X Y Z), `direction` (rotation of tables, where the file states it), `tool_length`, `limits_x` …
/// `limits_c`, `rate_x` … `rate_c`, `max_rotary`. `file` identifies the text in messages. Throws FormatError naming
/// file and line for faults in the text, std::invalid_argument for options that are wrong or missing.
MachineDescription describe_machine(std::string_view toml, const std::string& file, const std::string& name,
                                    OptionReader& options);

/// The texts of a description, for lists and panels.
struct MachineTexts {
  std::string summary;   ///< the one-line summary
  std::string language;  ///< one of kLanguages
  /// By language code ("de"): texts of the file, and names of its options, to their translations.
  std::map<std::string, std::map<std::string, std::string>> translations;
};

/// Throws FormatError as above.
MachineTexts machine_texts(std::string_view toml, const std::string& file);

/// The one-line summary for lists. Throws FormatError as above.
std::string machine_summary(std::string_view toml, const std::string& file);

}  // namespace riffler::nc
