// Program → NC code (RS-274).
#pragma once

#include <filesystem>
#include <string>

#include "nc/options.hpp"
#include "nc/program.hpp"

namespace riffler {

struct WriteOptions {
  std::string post = "tcp";         ///< a name of machines()
  double tolerance = 0.01;          ///< mm, tip between two rows to the straight line; at least 2e-5
  double axis_tolerance = 0.00175;  ///< rad, axis between two rows to the great circle; at least 1e-7
  Options options;                  ///< of the post
};

/// The text of the program: every row is the end of a block, with more blocks between two rows where the machine's
/// axes, moving linearly, would leave the tolerances. The same program gives the same bytes. Throws
/// std::invalid_argument naming the row that cannot be written, or the post or option that is not known.
std::string to_nc(const Program& program, const WriteOptions& options = {});

/// Writes it beside `path` and renames: the file is whole or not there.
void write_nc(const Program& program, const std::filesystem::path& path, const WriteOptions& options = {});

}  // namespace riffler
