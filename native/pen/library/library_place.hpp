// Where a maker's library lies. Its file is only looked for here: the program riffler-arm loads it (arm_process.hpp).
#pragma once

#include <initializer_list>
#include <string>

namespace riffler::pen {

/// Where a library lies, and whether the user has pointed to it.
struct LibraryPlace {
  std::string path;     // empty: it was not found
  bool chosen = false;  // by the environment variable
};

/// The file that the environment variable names, or else the first of `names` in the folders of LD_LIBRARY_PATH and of
/// the system.
LibraryPlace find_library(const char* variable, std::initializer_list<const char*> names);

}  // namespace riffler::pen
