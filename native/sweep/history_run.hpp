// Carves strokes of a history again, restricted to the tiles that an edit touches.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"
#include "sweep/tile_versions.hpp"

namespace riffler::sweep {

/// A change of the order of enabled strokes.
struct HistoryEdit {
  const PreparedStroke* out = nullptr;  ///< leaves it; null: none
  const PreparedStroke* in = nullptr;   ///< enters it, before the stroke with rank `at`; null: none
  std::size_t at = 0;
};

/// The new versions of one tile, from number `first` on.
struct TileRerun {
  std::size_t grid, tile;
  std::size_t first;                        ///< versions before it stay
  TileVersions tail;                        ///< their `tile` may be null, except in the last one
  std::shared_ptr<const dexel::Tile> last;  ///< the tile after all strokes
  bool restored;                            ///< whether an earlier version was the start

  // While it runs. Version k of the new order is number k − shift of the old one if that is at least `common`.
  std::size_t next, kept, common;
  std::ptrdiff_t shift;
  bool done = false;
};

/// Grids that edits share: copying one would cost as much as the volume has tiles.
struct HistoryScratch {
  explicit HistoryScratch(const Volume& base) : work(base.grids()) {}
  void fill_boxes(const Volume& base);

  std::vector<dexel::Grid> work;   ///< what strokes cut; threads use tiles of their own
  std::vector<dexel::Grid> boxes;  ///< full of material; empty before `fill_boxes`
};

struct HistoryRunStats {
  std::uint64_t strokes = 0, tiles = 0, moves = 0;
};

class HistoryRun {
 public:
  /// `versions`: by grid and tile. Everything must outlive the run and stay unchanged.
  HistoryRun(const Volume& base, const std::vector<std::vector<TileVersions>>& versions, HistoryScratch& scratch,
             const HistoryEdit& edit, std::size_t stride);
  HistoryRun(const HistoryRun&) = delete;
  HistoryRun& operator=(const HistoryRun&) = delete;
  ~HistoryRun();

  /// Carves. Throws Cancelled.
  void run(const Progress& progress);
  std::vector<TileRerun>& tiles() { return tiles_; }
  const HistoryRunStats& stats() const { return stats_; }

 private:
  struct Visit;
  using Unit = std::vector<std::size_t>;  // indices in tiles_, of one grid, that one thread carves

  void list_tiles(std::size_t grid);
  void begin(std::size_t grid, std::size_t tile, const PreparedStroke* out, const PreparedStroke* in);
  std::vector<Unit> units() const;
  bool small() const;
  std::vector<std::size_t> run_unit(const Unit& unit, HistoryRunStats& stats);
  const PreparedStroke& stroke_at(const TileRerun& tile, std::size_t k) const;
  std::size_t key(const PreparedStroke& stroke) const;
  const std::shared_ptr<const dexel::Tile>& before(const TileRerun& tile, std::size_t k) const;
  bool rejoin(TileRerun& tile) const;
  void carve(const PreparedStroke& stroke, std::span<TileRerun* const> tiles, HistoryRunStats& stats);
  std::shared_ptr<const dexel::Tile> cuttable(const PreparedStroke& stroke, const TileRerun& tile,
                                              dexel::TileBuilder& builder) const;
  void keep(TileRerun& tile) const;

  const Volume& base_;
  const std::vector<std::vector<TileVersions>>& versions_;
  HistoryScratch& scratch_;
  HistoryEdit edit_;
  std::size_t stride_;
  std::vector<TileRerun> tiles_;
  HistoryRunStats stats_;
};

}  // namespace riffler::sweep
