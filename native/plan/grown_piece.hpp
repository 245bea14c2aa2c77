// A piece of a tool grown by a margin on all sides, as convex pieces again.
#pragma once

#include <vector>

#include "riffler/tool/piece.hpp"

namespace riffler::plan {

/// Convex pieces whose union has the same lower side as the piece with everything within `margin` mm of it. Their
/// heights count from the tip of the tool that has not grown. Margin 0: the piece alone.
std::vector<tool::Piece> grown_lower_side(const tool::Piece& piece, double margin);

}  // namespace riffler::plan
