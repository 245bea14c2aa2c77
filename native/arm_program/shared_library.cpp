#include "arm_program/shared_library.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <utility>

#include "riffler/pen/hid/open_error.hpp"

namespace riffler::arm_program {

using pen::OpenError;
using pen::OpenProblem;

SharedLibrary::SharedLibrary(std::string path) : path_(std::move(path)) {
  // For a name without a folder the system would search other folders than the user may expect.
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

}  // namespace riffler::arm_program
