// The versions of a tile after the strokes of a history that touch it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "riffler/dexel/tile.hpp"
#include "riffler/sweep/history_stroke.hpp"
#include "sweep/convex_group.hpp"
#include "sweep/touched_tiles.hpp"

namespace riffler::sweep {

/// A stroke of a history, with what editing it needs.
struct PreparedStroke {
  StrokeId id;
  HistoryStroke stroke;
  std::vector<ConvexGroup> cutter;    ///< empty for a hand tool
  std::vector<TouchedTiles> touched;  ///< one per grid
  std::size_t rank;                   ///< its place in the history's order
};

/// A tile after a stroke.
struct TileVersion {
  const PreparedStroke* stroke;
  std::shared_ptr<const dexel::Tile> tile;  ///< null: not kept
};

/// The versions of one tile after the enabled strokes that touch it, in order. The last one is always kept.
using TileVersions = std::vector<TileVersion>;

/// Whether two tiles have the same spans and normals, bit by bit.
bool same_bytes(const dexel::Tile& a, const dexel::Tile& b);

/// Drops versions, so that each kept one is at least `stride` strokes after the one kept before it. A version that a
/// stroke left unchanged costs nothing and stays. Keeps the last one.
void thin(TileVersions& versions, std::size_t stride) noexcept;

/// Number and bytes of the kept versions from number `from` on. `base` is the tile before all strokes, which costs
/// nothing.
struct VersionCost {
  std::size_t count = 0, bytes = 0;
};
VersionCost cost_of(const TileVersions& versions, const dexel::Tile* base, std::size_t from = 0);

}  // namespace riffler::sweep
