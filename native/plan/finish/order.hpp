// The order and direction in which pieces are cut.
#pragma once

#include <vector>

#include "plan/finish/patterns.hpp"

namespace riffler::plan {

/// The pieces in an order with short distances between them: from the end of one to the nearest end of another. Starts
/// at the first piece; `pieces` are sorted by rank, and places whose y differs by no more than their rank count as
/// near.
std::vector<CutPiece> in_short_order(std::vector<CutPiece> pieces);

/// Pieces from the top downwards, each with its direction kept: what lies below a piece, within `near` (mm) seen along
/// the axis, follows it. Closed pieces begin where the one before ends.
std::vector<CutPiece> descending(std::vector<CutPiece> pieces, double near);

}  // namespace riffler::plan
