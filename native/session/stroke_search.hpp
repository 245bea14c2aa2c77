// Which stroke of a journal made a surface.
#pragma once

#include <map>

#include "riffler/session/journal.hpp"
#include "riffler/sweep/cut_search.hpp"

namespace riffler::session {

/// A search whose ids are the numbers of the strokes that count. Strokes that mask or smooth are left out: they sweep
/// no surface. `tools`: the journal's, by number. Throws std::invalid_argument as CutSearch.
sweep::CutSearch stroke_search(const Journal& journal, const std::map<int, Tool>& tools, double tolerance);

}  // namespace riffler::session
