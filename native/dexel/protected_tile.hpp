// What a brush changes of a tile, outside a protected region, and how much that is.
#pragma once

#include <memory>
#include <span>

#include "riffler/dexel/grid.hpp"

namespace riffler::dexel {

/// `after`, with the material of `before` inside the region `kept`: tile number `tile` of `grid`, all three of it.
std::shared_ptr<const Tile> with_protected(const Grid& grid, std::size_t tile,
                                           const std::shared_ptr<const Tile>& before,
                                           const std::shared_ptr<const Tile>& after,
                                           const std::shared_ptr<const Tile>& kept);

/// Length of the parts of one ray that only `a` contains, mm.
double length_without(std::span<const Span> a, std::span<const Span> b);

}  // namespace riffler::dexel
