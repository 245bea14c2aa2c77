#include "base/path_text.hpp"

namespace riffler::base {

std::string path_text(const std::filesystem::path& path) {
  return path.native();
}

std::filesystem::path text_path(const std::string& text) {
  return text;
}

}  // namespace riffler::base
