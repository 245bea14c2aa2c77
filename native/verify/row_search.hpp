// Which row of a program made a surface.
#pragma once

#include <map>

#include "riffler/nc/program.hpp"
#include "riffler/sweep/cut_search.hpp"

namespace riffler::verify {

/// A search whose ids are the program's rows. `own`: tools that take precedence over the program's of the same number.
/// Throws std::invalid_argument for a tool without a shape, as a verification does, and as CutSearch.
sweep::CutSearch row_search(const nc::Program& program, std::map<int, Tool> own, double tolerance);

}  // namespace riffler::verify
