// Program → NC code.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "riffler/nc/program.hpp"
#include "riffler/nc/write/write_options.hpp"

namespace riffler::nc {

/// The text of the program: every row is the end of a block, with more blocks between two rows where the machine's
/// axes, moving linearly, would leave the tolerances. The same program gives the same bytes. Throws
/// std::invalid_argument naming the row that cannot be written, or the post or option that is not known.
std::string to_nc(const Program& program, const WriteOptions& options = {}, WriteReport* report = nullptr);

/// Writes it beside `path` and renames: the file is whole or not there. What `check` throws comes before that.
WriteReport write_nc(const Program& program, const std::filesystem::path& path, const WriteOptions& options = {},
                     const std::function<void(const WriteReport&)>& check = {});

}  // namespace riffler::nc
