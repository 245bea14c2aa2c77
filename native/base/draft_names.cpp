#include "base/draft_names.hpp"

#include <random>
#include <stdexcept>
#include <string>
#include <system_error>

#include "base/atomic_file.hpp"
#include "base/path_text.hpp"

namespace riffler::base {

namespace fs = std::filesystem;

fs::path followed(const fs::path& path) {
  constexpr int kMaxLinks = 40;  // the limit of Linux
  fs::path at = path;
  std::error_code error;
  for (int k = 0; fs::is_symlink(fs::symlink_status(at, error)); ++k) {
    const fs::path to = fs::read_symlink(at, error);
    if (error || k == kMaxLinks) throw std::runtime_error(file_name(path) + ": a link that leads nowhere");
    at = to.is_absolute() ? to : at.parent_path() / to;
  }
  return at;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

fs::path random_draft(const fs::path& path) {
  static const char kLetters[] = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device random;
  std::string letters;
  for (int k = 0; k < 12; ++k) letters += kLetters[random() % (sizeof kLetters - 1)];
  fs::path out = draft_prefix(path);
  out += letters;
  return out;
}

fs::path draft_prefix(const fs::path& path) {
  constexpr std::size_t kLongest = 200;  // of a name, whose limit is 255 bytes or characters
  fs::path::string_type name = fs::path(".").native() + path.filename().native().substr(0, kLongest);
  return folder_of(path) / (name + fs::path(".riffler-").native());
}

}  // namespace riffler::base
