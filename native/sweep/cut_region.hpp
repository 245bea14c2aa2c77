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
  /// `protect`: grid of the region that must not change; null for none.
  GridRegion(const dexel::Grid& whole, CarveMode mode, const dexel::Grid* protect);

  /// Grid of the material that may be cut, in the opened tiles.
  dexel::Grid& cuttable() { return cuttable_; }
  bool opened(std::size_t tile) const { return before_[tile] != nullptr; }
  /// Computes the cuttable material of these tiles, which must not have been opened before.
  void open(std::span<const std::size_t> tiles);

  /// The opened tiles that have been cut.
  std::vector<std::size_t> changed() const;
  /// A changed tile of the whole grid after the cut. `builder` is scratch space, empty before and after the call.
  std::shared_ptr<const dexel::Tile> composite(std::size_t tile, dexel::TileBuilder& builder) const;

 private:
  const dexel::Grid& whole_;
  const dexel::Grid* protect_;
  CarveMode mode_;
  dexel::Grid cuttable_;
  std::optional<dexel::Grid> box_;                          // full of material; minus the whole grid, it gives the air
  std::vector<std::shared_ptr<const dexel::Tile>> before_;  // as opened; null: not opened
};

/// What a carve with CarveMode::Add or `protect` cuts: the air in the volume's box or its material, minus the protected
/// region. The kernels are those of a plain carve, so tolerance, forces and guarantees are the same in both modes.
class CutRegion {
 public:
  /// Throws std::invalid_argument if `protect` has another frame; it may be null. `volume` and `protect` must outlive
  /// the region and must not change before `commit`.
  static CutRegion of(const Volume& volume, CarveMode mode, const Volume* protect);

  GridRegion& grid(std::size_t g) { return grids_[g]; }
  /// Removes the cut material from `volume`, or adds it. Returns whether a tile changed. If it throws, no tile has
  /// changed.
  bool commit(Volume& volume) const;

 private:
  std::vector<GridRegion> grids_;
};

/// One tile of a whole volume after a cut of the cuttable material. `whole`: the tile before the cut. `before`: the
/// cuttable material. `rest`: the cuttable material after the cut. `tile`: number of the tile in `grid`. Returns
/// `whole` itself if nothing was cut. `builder` is scratch space, empty before and after the call.
std::shared_ptr<const dexel::Tile> composite_tile(CarveMode mode, const dexel::Grid& grid, std::size_t tile,
                                                  const std::shared_ptr<const dexel::Tile>& whole,
                                                  const std::shared_ptr<const dexel::Tile>& before,
                                                  const std::shared_ptr<const dexel::Tile>& rest,
                                                  dexel::TileBuilder& builder);

}  // namespace riffler::sweep
