// What becomes of a tile when something of it was put on, or cut beside what is protected.
#pragma once

#include <cstddef>
#include <memory>

#include "dexel/volume.hpp"
#include "sweep/carve_options.hpp"

namespace riffler {

/// Such a carve cuts a volume of its own, of what may be cut: the material of `whole`, or the air in it, less what is
/// protected. `before` is that volume's tile (number `tile` of `grid`) and `rest` what is left of it. The tile of the
/// whole then: `whole` less what was cut, or with it. Where nothing was, `whole` itself. `builder` is empty, and is so
/// again afterwards.
std::shared_ptr<const Tile> worked_tile(CarveMode mode, const Grid& grid, std::size_t tile,
                                        const std::shared_ptr<const Tile>& whole,
                                        const std::shared_ptr<const Tile>& before,
                                        const std::shared_ptr<const Tile>& rest, TileBuilder& builder);

}  // namespace riffler
