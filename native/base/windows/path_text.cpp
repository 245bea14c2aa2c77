#include "base/path_text.hpp"

#include "base/windows/wide.hpp"

namespace riffler::base {

std::string path_text(const std::filesystem::path& path) {
  return from_wide(path.native());
}

std::filesystem::path text_path(const std::string& text) {
  return to_wide(text);
}

}  // namespace riffler::base
