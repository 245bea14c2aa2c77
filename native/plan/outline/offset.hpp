// Closed loops at a distance from a set's border.
#pragma once

#include <vector>

#include "plan/outline/border.hpp"

namespace riffler::plan {

/// An area in which the cutter should run, but which is too narrow for it.
struct NarrowPlace {
  Vec2 place{0};      ///< the place of the area farthest from the border
  double width = 0;   ///< twice the distance of that place from the border, mm
  double length = 0;  ///< length of the area's border, mm
};

/// Loops around the set and in its holes, with the set on their left.
struct OffsetLoops {
  std::vector<std::vector<Vec2>> loops;  ///< the first point of a loop is not repeated
  std::vector<NarrowPlace> narrow;
};

/// Finds the loops. Each straight piece of a loop is at least `distance` from the border, and at most `tolerance`
/// farther, except in corners that a disc with this radius does not reach. `in`: places of the set. The grid must
/// contain all loops. All lengths in mm.
OffsetLoops offset_loops(const PlaceGrid& grid, const PlaceSet& in, const SetBorder& border, double distance,
                         double tolerance);

}  // namespace riffler::plan
