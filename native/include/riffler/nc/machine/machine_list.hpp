// The machines that programs are written for and read from: those that come with Riffler
// (native/nc/machine/shipped/*.toml), and files of the user's own.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "riffler/base/descriptions.hpp"

namespace riffler::nc {

/// All machines, ours first, then every *.toml in the folders of RIFFLER_MACHINES (apart as in PATH) and in
/// riffler/machines of the user's folder for settings; of a file that cannot be read the description says why.
std::vector<base::DescriptionEntry> machines();

/// The names of those with an axis of this letter whose control reads `language`, apart by commas.
std::string machines_with(char axis, std::string_view language = "rs274");

/// The names of machines() whose control reads `language`, apart by commas.
std::string machines_of_language(std::string_view language);

}  // namespace riffler::nc
