// Where the code of this library lies.
#pragma once

#include <filesystem>

namespace riffler::base {

/// Folder of the module or program that the core is linked into; empty if the system does not know it.
std::filesystem::path module_folder();

}  // namespace riffler::base
