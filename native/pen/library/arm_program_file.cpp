#include "pen/library/arm_program_file.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {

std::string arm_program_file() {
  namespace fs = std::filesystem;
  if (const char* const given = std::getenv(kArmProgramVariable); given != nullptr && *given != '\0') return given;
  ::Dl_info here{};
  std::error_code ignored;
  fs::path folder;
  if (::dladdr(reinterpret_cast<void*>(&arm_program_file), &here) != 0 && here.dli_fname != nullptr)
    folder = fs::weakly_canonical(here.dli_fname, ignored).parent_path();
  for (const char* const place : {"riffler-arm", "../libexec/riffler/riffler-arm"})
    if (const fs::path file = folder / place; fs::is_regular_file(file, ignored)) return file.string();
  throw OpenError(OpenProblem::NotInstalled, "the program riffler-arm, which loads the arm's library, is not in " +
                                                 folder.string() + "; install Riffler again, or set " +
                                                 kArmProgramVariable + " to its whole path");
}

}  // namespace riffler::pen
