#include "pen/library/arm_program_file.hpp"

#include <filesystem>
#include <system_error>

#include "base/environment.hpp"
#include "base/own_module.hpp"
#include "base/path_text.hpp"
#include "riffler/pen/hid/open_error.hpp"

namespace riffler::pen {

std::string arm_program_file() {
  namespace fs = std::filesystem;
  if (const std::string given = base::environment(kArmProgramVariable).value_or(""); !given.empty()) return given;
  const fs::path folder = base::module_folder();
  std::error_code ignored;
  for (const char* const place : {"riffler-arm", "../libexec/riffler/riffler-arm"})
    if (const fs::path file = folder / place; fs::is_regular_file(file, ignored)) return base::path_text(file);
  throw OpenError(OpenProblem::NotInstalled, "the program riffler-arm, which loads the arm's library, is not in " +
                                                 base::path_text(folder) + "; install Riffler again, or set " +
                                                 kArmProgramVariable + " to its whole path");
}

}  // namespace riffler::pen
