// Closed loops at a distance from a set's border.
#pragma once

#include <vector>

#include "plan/outline/border.hpp"

namespace riffler::plan {

/// A part of the plane that the cutter is to run in, but does not fit into.
struct NarrowPlace {
  Vec2 place{0};      ///< the place farthest from the border
  double width = 0;   ///< mm, twice that distance
  double length = 0;  ///< mm, of the border
};

/// Loops around the set, the set on their left, and in its holes.
struct OffsetLoops {
  std::vector<std::vector<Vec2>> loops;  ///< the first point of a loop is not repeated
  std::vector<NarrowPlace> narrow;
};

/// Loops of which each straight piece keeps `distance` from the border and is at most `tolerance` farther away, except
/// in corners that a disc of that radius does not reach. `in`: places of the set. The grid reaches beyond all loops.
OffsetLoops offset_loops(const PlaceGrid& grid, const PlaceSet& in, const SetBorder& border, double distance,
                         double tolerance);

}  // namespace riffler::plan
