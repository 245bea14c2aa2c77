// Where the vertex of a cycle goes.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "marching/bricks.hpp"
#include "marching/cases.hpp"
#include "marching/float_grid.hpp"
#include "marching/hits.hpp"

namespace riffler::marching {

/// A cycle of a cell: its edges' hits, in the entry's order.
struct Cycle {
  Vec3i cell;
  const CellCase& entry;
  int number;
  std::array<const Hit*, 12> hits;  // from entry.begin[number] on
};

struct Placed {
  Vec3 place;
  std::uint8_t marks = 0;
  Vec3 anchor{0}, other{0};  // of a special: Special::anchor, Special::other
};

/// The vertex of a cycle. `siblings` are the places of the cell's vertices so far: no two share one.
Placed place_vertex(const FloatGrid& grid, const Cycle& cycle, const std::vector<Vec3>& siblings);

}  // namespace riffler::marching
