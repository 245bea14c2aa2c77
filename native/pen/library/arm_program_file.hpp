// Where the program riffler-arm lies.
#pragma once

#include <string>

namespace riffler::pen {

inline constexpr const char* kArmProgramVariable = "RIFFLER_ARM_PROGRAM";

/// The file that the environment variable names, or else riffler-arm next to the module or program that holds this
/// code, or in ../libexec/riffler from there. Throws OpenError (NotInstalled).
std::string arm_program_file();

}  // namespace riffler::pen
