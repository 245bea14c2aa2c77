// Program to NC code.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "riffler/nc/program.hpp"
#include "riffler/nc/write/write_options.hpp"

namespace riffler::nc {

/// The NC text of the program. Every row ends a block; further blocks are added between two rows where the linearly
/// moving axes would exceed the tolerances. The same program gives the same bytes. Throws std::invalid_argument naming
/// the row that cannot be written, or an unknown post or option. `report`: filled if not null.
std::string to_nc(const Program& program, const WriteOptions& options = {}, WriteReport* report = nullptr);

/// Writes the NC text atomically, under a temporary name that is then renamed. `check` sees the report first; if it
/// throws, nothing is written.
WriteReport write_nc(const Program& program, const std::filesystem::path& path, const WriteOptions& options = {},
                     const std::function<void(const WriteReport&)>& check = {});

}  // namespace riffler::nc
