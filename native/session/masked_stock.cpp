#include "session/masked_stock.hpp"

#include <cstdint>
#include <utility>
#include <vector>

#include "riffler/dexel/boolean.hpp"
#include "sweep/cut_region.hpp"

namespace riffler::session {

MaskedStock::MaskedStock(const Volume& stock, sweep::CarveMode mode, const Volume* protect)
    : mode_(mode), stock_(stock), masked_stock_(mode == sweep::CarveMode::Add ? Volume::block(stock.frame()) : stock) {
  if (protect) check_same_grid(stock.frame(), protect->frame(), "protect");
  if (mode == sweep::CarveMode::Add) apply(dexel::Boolean::Subtract, masked_stock_, stock);
  if (protect) apply(dexel::Boolean::Subtract, masked_stock_, *protect);
}

void MaskedStock::show(const Volume& left, std::span<const TileExchange::Place> places, Volume& shown) const {
  dexel::TileBuilder builder(shown.grids().front().has_normals());
  bool any = false;
  for (const TileExchange::Place& p : places) {
    dexel::Grid& grid = shown.grids()[p.grid];
    const auto& stock = stock_.grids()[p.grid].shared_tile(p.tile);
    const auto& before = masked_stock_.grids()[p.grid].shared_tile(p.tile);
    const auto& rest = left.grids()[p.grid].shared_tile(p.tile);
    auto whole = composite_tile(mode_, grid, p.tile, stock, before, rest, builder);
    if (whole == grid.shared_tile(p.tile)) continue;
    grid.set_tile(p.tile, std::move(whole));
    any = true;
  }
  if (any) shown.touch();
}

Volume MaskedStock::whole(const Volume& left) const {
  std::vector<TileExchange::Place> changed;
  for (std::uint32_t g = 0; g < left.grids().size(); ++g)
    for (std::uint32_t t = 0; t < left.grids()[g].tile_count(); ++t)
      if (left.grids()[g].shared_tile(t) != masked_stock_.grids()[g].shared_tile(t)) changed.push_back({g, t});
  Volume out = stock_;
  show(left, changed, out);
  return out;
}

}  // namespace riffler::session
