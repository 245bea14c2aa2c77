// Pieces of a shank or holder as groups for sweeping, to test whether they touch material.
#pragma once

#include <vector>

#include "sweep/convex_group.hpp"

namespace riffler::sweep {

/// One group per piece, since pieces may overlap or leave gaps in any order. Each is smaller by `by` (mm) on all sides,
/// but never by more than a quarter, so that mere contact removes nothing; 0: of the same size.
std::vector<ConvexGroup> body_groups(const std::vector<tool::Frustum>& pieces, double by);

}  // namespace riffler::sweep
