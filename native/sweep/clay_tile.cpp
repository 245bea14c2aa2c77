#include "sweep/clay_tile.hpp"

#include "dexel/boolean.hpp"

namespace riffler {

std::shared_ptr<const Tile> worked_tile(CarveMode mode, const Grid& grid, std::size_t tile,
                                        const std::shared_ptr<const Tile>& whole,
                                        const std::shared_ptr<const Tile>& before,
                                        const std::shared_ptr<const Tile>& rest, TileBuilder& builder) {
  if (rest == before) return whole;
  const bool remove = mode == CarveMode::Remove;
  if (remove && before == whole) return rest;  // nothing of it is protected
  const auto cut = apply(Boolean::Subtract, grid, tile, before, rest, builder);
  return apply(remove ? Boolean::Subtract : Boolean::Add, grid, tile, whole, cut, builder);
}

}  // namespace riffler
