#include "sweep/cut_region.hpp"

#include <utility>

#include "riffler/base/parallel.hpp"
#include "riffler/dexel/boolean.hpp"

namespace riffler::sweep {

namespace {

using TilePtr = std::shared_ptr<const dexel::Tile>;

/// Calls f(k, builder) for k < count, on all threads.
template <class F>
void for_each_tile(std::size_t count, bool with_normals, const F& f) {
  constexpr std::size_t grain = 4;
  base::parallel_for(count, grain, [&](std::size_t begin, std::size_t end) {
    dexel::TileBuilder builder(with_normals);
    for (std::size_t k = begin; k < end; ++k) f(k, builder);
  });
}

}  // namespace

GridRegion::GridRegion(const dexel::Grid& whole, CarveMode mode, const dexel::Grid* protect)
    : whole_(whole), protect_(protect), mode_(mode), cuttable_(whole), before_(whole.tile_count()) {
  if (mode == CarveMode::Add) box_.emplace(whole).fill();
}

void GridRegion::open(std::span<const std::size_t> tiles) {
  for_each_tile(tiles.size(), whole_.has_normals(), [&](std::size_t k, dexel::TileBuilder& builder) {
    const std::size_t t = tiles[k];
    TilePtr tile = whole_.shared_tile(t);
    if (box_) tile = apply(dexel::Boolean::Subtract, whole_, t, box_->shared_tile(t), tile, builder);
    if (protect_) tile = apply(dexel::Boolean::Subtract, whole_, t, tile, protect_->shared_tile(t), builder);
    cuttable_.set_tile(t, tile);
    before_[t] = std::move(tile);
  });
}

std::vector<std::size_t> GridRegion::changed() const {
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < before_.size(); ++t)
    if (opened(t) && cuttable_.shared_tile(t) != before_[t]) out.push_back(t);
  return out;
}

TilePtr GridRegion::composite(std::size_t tile, dexel::TileBuilder& builder) const {
  return composite_tile(mode_, whole_, tile, whole_.shared_tile(tile), before_[tile], cuttable_.shared_tile(tile),
                        builder);
}

CutRegion CutRegion::of(const Volume& volume, CarveMode mode, const Volume* protect) {
  if (protect) check_same_grid(volume.frame(), protect->frame(), "protect");
  CutRegion region;
  region.grids_.reserve(volume.grids().size());
  for (std::size_t g = 0; g < volume.grids().size(); ++g)
    region.grids_.emplace_back(volume.grids()[g], mode, protect ? &protect->grids()[g] : nullptr);
  return region;
}

bool CutRegion::commit(Volume& volume) const {
  struct Change {
    std::size_t grid, tile;
    TilePtr after;
  };
  std::vector<Change> changes;
  for (std::size_t g = 0; g < grids_.size(); ++g)
    for (const std::size_t t : grids_[g].changed()) changes.push_back({g, t, nullptr});
  for_each_tile(changes.size(), volume.grids().front().has_normals(), [&](std::size_t k, dexel::TileBuilder& builder) {
    changes[k].after = grids_[changes[k].grid].composite(changes[k].tile, builder);
  });
  // Nothing below throws: the volume changes as a whole or not at all.
  bool any = false;
  for (Change& c : changes) {
    dexel::Grid& grid = volume.grids()[c.grid];
    if (c.after == grid.shared_tile(c.tile)) continue;
    grid.set_tile(c.tile, std::move(c.after));
    any = true;
  }
  return any;
}

TilePtr composite_tile(CarveMode mode, const dexel::Grid& grid, std::size_t tile, const TilePtr& whole,
                       const TilePtr& before, const TilePtr& rest, dexel::TileBuilder& builder) {
  if (rest == before) return whole;
  const bool remove = mode == CarveMode::Remove;
  if (remove && before == whole) return rest;  // nothing in the tile is protected
  const TilePtr cut = apply(dexel::Boolean::Subtract, grid, tile, before, rest, builder);
  return apply(remove ? dexel::Boolean::Subtract : dexel::Boolean::Add, grid, tile, whole, cut, builder);
}

}  // namespace riffler::sweep
