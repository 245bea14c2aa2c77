// The machines for which programs are written and read: those shipped with Riffler (native/nc/machine/shipped/*.toml),
// and the user's own files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "riffler/base/descriptions.hpp"

namespace riffler::nc {

/// All machines: the shipped ones, then every *.toml in the folders of RIFFLER_MACHINES (separated as in PATH) and in
/// riffler/machines of the user's configuration folder. The description of an unreadable file states the reason.
std::vector<base::DescriptionEntry> machines();

/// Comma-separated names of the machines that have an axis with letter `axis` and whose control reads `language`.
std::string machines_with(char axis, std::string_view language = "rs274");

/// Comma-separated names of the machines whose control reads `language`.
std::string machines_of_language(std::string_view language);

}  // namespace riffler::nc
