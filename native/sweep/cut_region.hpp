// The part of a volume that a carve may change, as tiles of its own.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/sweep/carve_options.hpp"

namespace riffler::sweep {

/// One grid of a CutRegion.
class GridRegion {
 public:
  /// `protect`: the grid of what must not change, or null.
  GridRegion(const dexel::Grid& whole, CarveMode mode, const dexel::Grid* protect);

  /// Holds what may be cut, in the tiles that were opened.
  dexel::Grid& cuttable() { return cuttable_; }
  bool opened(std::size_t tile) const { return before_[tile] != nullptr; }
  /// Computes what may be cut of these tiles, none of which was opened before.
  void open(std::span<const std::size_t> tiles);

  /// The tiles of which something was cut since they were opened.
  std::vector<std::size_t> changed() const;
  /// A changed tile of the whole grid as the cut leaves it. `builder` is empty, and is empty again afterwards.
  std::shared_ptr<const dexel::Tile> composite(std::size_t tile, dexel::TileBuilder& builder) const;

 private:
  const dexel::Grid& whole_;
  const dexel::Grid* protect_;
  CarveMode mode_;
  dexel::Grid cuttable_;
  std::optional<dexel::Grid> box_;                          // full of material: air is what the whole lacks of it
  std::vector<std::shared_ptr<const dexel::Tile>> before_;  // as opened; null: not opened
};

/// What CarveMode::Add and `protect` cut: the air in a volume's box or its material, less what is protected. The same
/// kernels cut it as cut a plain volume, so tolerance, forces and guarantees are the same for both modes.
class CutRegion {
 public:
  /// Throws std::invalid_argument if `protect` (or null) has another frame. `volume` and `protect` must outlive the
  /// region and must not change before `commit`.
  static CutRegion of(const Volume& volume, CarveMode mode, const Volume* protect);

  GridRegion& grid(std::size_t g) { return grids_[g]; }
  /// Takes what was cut from `volume`, or adds it. Returns whether a tile changed. Where it throws, none did.
  bool commit(Volume& volume) const;

 private:
  std::vector<GridRegion> grids_;
};

/// One tile of a whole volume after a cut of what may be changed of it. `whole`: the tile before the cut. `before`:
/// what could be cut of it. `rest`: what the cut left of that. `tile` is its number in `grid`. Returns `whole` itself
/// where nothing was cut. `builder` is empty, and is empty again afterwards.
std::shared_ptr<const dexel::Tile> composite_tile(CarveMode mode, const dexel::Grid& grid, std::size_t tile,
                                                  const std::shared_ptr<const dexel::Tile>& whole,
                                                  const std::shared_ptr<const dexel::Tile>& before,
                                                  const std::shared_ptr<const dexel::Tile>& rest,
                                                  dexel::TileBuilder& builder);

}  // namespace riffler::sweep
