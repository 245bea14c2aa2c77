// Checks of patches from callers and files.
#pragma once

#include "riffler/nurbs/patch.hpp"

namespace riffler::nurbs {

/// Throws std::invalid_argument that names argument and row, and a remedy.
void check_patch(const Patch& patch);

}  // namespace riffler::nurbs
