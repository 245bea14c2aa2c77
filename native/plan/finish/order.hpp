// The order and direction in which pieces are cut.
#pragma once

#include <vector>

#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// Orders pieces so that the moves between them are short: starts with the piece of smallest rank, then takes the
/// nearest end of another piece, among the unvisited pieces of nearest rank.
std::vector<CutPiece> in_short_order(std::vector<CutPiece> pieces);

/// Orders pieces from the top downwards and keeps their directions. A piece is followed by the one below it, within
/// `near` (mm) seen along the axis. Closed pieces begin near the end of the previous piece.
std::vector<CutPiece> descending(std::vector<CutPiece> pieces, double near);

}  // namespace riffler::plan
