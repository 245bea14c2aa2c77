// Paths as texts for users, in UTF-8 on every system.
#pragma once

#include <filesystem>
#include <string>

namespace riffler::base {

/// The whole path in UTF-8; on Linux its bytes. path::string() would throw on Windows for a name that the user's code
/// page does not have.
std::string path_text(const std::filesystem::path& path);

/// The last part of the path, for messages.
inline std::string file_name(const std::filesystem::path& path) {
  return path_text(path.filename());
}

/// The path that `text`, in UTF-8, names.
std::filesystem::path text_path(const std::string& text);

}  // namespace riffler::base
