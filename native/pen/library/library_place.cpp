#include "pen/library/library_place.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <vector>

namespace riffler::pen {
namespace {

constexpr const char* kFolders[] = {
    "/usr/local/lib", "/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/lib/x86_64-linux-gnu", "/usr/lib64",
    "/usr/lib",       "/usr/local/lib64"};

std::vector<std::string> library_folders() {
  std::vector<std::string> out;
  const char* const given = std::getenv("LD_LIBRARY_PATH");
  std::string_view rest = given == nullptr ? "" : given;
  while (!rest.empty()) {
    const std::string_view folder = rest.substr(0, rest.find(':'));
    if (folder.starts_with('/')) out.emplace_back(folder);
    rest.remove_prefix(std::min(folder.size() + 1, rest.size()));
  }
  out.insert(out.end(), std::begin(kFolders), std::end(kFolders));
  return out;
}

}  // namespace

LibraryPlace find_library(const char* variable, std::initializer_list<const char*> names) {
  if (const char* const given = std::getenv(variable); given != nullptr && *given != '\0') return {given, true};
  for (const std::string& folder : library_folders())
    for (const char* const name : names)
      if (const std::string path = folder + "/" + name; ::access(path.c_str(), R_OK) == 0) return {path, false};
  return {};
}

}  // namespace riffler::pen
