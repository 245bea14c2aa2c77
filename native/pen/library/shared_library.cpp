#include "pen/library/shared_library.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "riffler/pen/hid/open_error.hpp"

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

SharedLibrary::SharedLibrary(std::string path) : path_(std::move(path)) {
  // Without a folder the system would look for the name elsewhere than its user may think.
  if (!path_.starts_with('/'))
    throw OpenError(OpenProblem::NotInstalled, path_ + ": give the library's whole path, which begins with /");
  if (::access(path_.c_str(), F_OK) != 0) throw OpenError(OpenProblem::NotInstalled, path_ + ": no such file");
  handle_ = ::dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (handle_ == nullptr) {
    const char* const why = ::dlerror();
    throw OpenError(OpenProblem::WrongLibrary,
                    path_ + ": the system cannot load it: " + (why == nullptr ? "no reason given" : why));
  }
}

void* SharedLibrary::symbol(const char* name) const {
  return ::dlsym(handle_, name);
}

void* SharedLibrary::required(const char* name) const {
  void* const found = symbol(name);
  if (found == nullptr)
    throw OpenError(OpenProblem::WrongLibrary, path_ + ": it has no function " + name + "; is it of another version?");
  return found;
}

}  // namespace riffler::pen
