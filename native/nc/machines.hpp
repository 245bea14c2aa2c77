// The machines that programs are written for and read from: those that come with Riffler (native/nc/machines/*.toml),
// and files of the user's own.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "nc/machine.hpp"
#include "nc/options.hpp"

namespace riffler {

struct MachineEntry {
  std::string name, description;
};

/// All machines, ours first, then every *.toml in own_machine_folders(); of a file that cannot be read the description
/// says why.
std::vector<MachineEntry> machines();

/// RIFFLER_MACHINES (folders, apart as in PATH), then riffler/machines in the user's folder for settings.
std::vector<std::filesystem::path> own_machine_folders();

/// `name` is one of machines(), or the path of a .toml file. Options that the machine does not take stay in `options`.
/// Throws std::invalid_argument that lists the known ones, and what describe_machine throws.
std::unique_ptr<Machine> make_machine(std::string_view name, OptionReader& options);

}  // namespace riffler
