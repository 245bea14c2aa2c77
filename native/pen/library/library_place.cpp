#include "pen/library/library_place.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/environment.hpp"
#include "base/path_text.hpp"

namespace riffler::pen {
namespace {

constexpr const char* kFolders[] = {
    "/usr/local/lib", "/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/lib/x86_64-linux-gnu", "/usr/lib64",
    "/usr/lib",       "/usr/local/lib64"};

std::vector<std::string> library_folders() {
  std::vector<std::string> out;
  const std::string given = base::environment("LD_LIBRARY_PATH").value_or("");
  std::string_view rest = given;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    if (folder.starts_with('/')) out.emplace_back(folder);
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
  }
  out.insert(out.end(), std::begin(kFolders), std::end(kFolders));
  return out;
}

bool readable(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(base::text_path(path), error) && std::ifstream(base::text_path(path)).good();
}

}  // namespace

LibraryPlace find_library(const char* variable, std::initializer_list<const char*> names) {
  if (const std::string given = base::environment(variable).value_or(""); !given.empty()) return {given, true};
  for (const std::string& folder : library_folders())
    for (const char* const name : names)
      if (const std::string path = folder + "/" + name; readable(path)) return {path, false};
  return {};
}

}  // namespace riffler::pen
