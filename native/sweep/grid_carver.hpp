// Carves one grid with the moves of a tool, in batches.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "sweep/cut_region.hpp"
#include "sweep/steps.hpp"
#include "sweep/tile_cutter.hpp"

namespace riffler::sweep {

/// Restores the replaced tiles unless the carve is committed. Its cost depends on the size of the cut, not on the
/// volume.
class Rollback {
 public:
  Rollback() = default;
  Rollback(const Rollback&) = delete;
  Rollback& operator=(const Rollback&) = delete;
  ~Rollback() { undo(); }
  void undo() {
    for (auto& [place, tile] : first_) place.first->set_tile(place.second, std::move(tile));
    first_.clear();
  }
  void keep(dexel::Grid& grid, std::size_t tile) { first_.try_emplace({&grid, tile}, grid.shared_tile(tile)); }
  /// Calls visit(grid, tile) for each replaced tile.
  template <class Visit>
  void each(const Visit& visit) const {
    for (const auto& [place, tile] : first_) visit(*place.first, place.second);
  }
  /// Keeps the changes. Returns whether any tile was replaced.
  bool commit() {
    const bool any = !first_.empty();
    first_.clear();
    return any;
  }

 private:
  using Place = std::pair<dexel::Grid*, std::size_t>;
  using Kept = std::pair<const Place, std::shared_ptr<const dexel::Tile>>;
  std::map<Place, std::shared_ptr<const dexel::Tile>, std::less<>, base::BlockAllocator<Kept>> first_;
};

class GridCarver {
 public:
  /// `measured`: whether removed material counts towards `cut`. `rollback` may be null.
  GridCarver(dexel::Grid& grid, bool measured, const CarveOptions& options, Cut& cut, Rollback* rollback)
      : grid_(grid), measured_(measured), options_(options), cut_(cut), rollback_(rollback) {}
  /// Cuts the cuttable material of a region. The region's commit changes the volume, not the carver.
  GridCarver(GridRegion& region, bool measured, const CarveOptions& options, Cut& cut)
      : GridCarver(region.cuttable(), measured, options, cut, nullptr) {
    region_ = &region;
  }

  /// Move m of `moves` goes to poses[end(m)] from the pose before it. Holds only one batch in memory, regardless of the
  /// length of the program.
  template <class End, class Done>
  void run(std::span<const ConvexGroup> cutter, std::span<const Pose> poses, std::size_t moves, const End& end,
           const Done& moves_done) {
    steps_.clear(), motions_.clear();  // left over from a run that failed
    Pose from;
    std::size_t last = 0;
    for (std::size_t m = 0; m < moves; ++m) {
      const std::size_t e = end(m);
      if (m == 0 || last != e - 1) from = to_local(grid_.axis(), poses[e - 1]);
      last = e;
      const Pose to = to_local(grid_.axis(), poses[e]);
      add(cutter, from, to, static_cast<std::uint32_t>(m));
      if (full()) flush(), moves_done(m);
      from = to;
    }
    flush();
  }

  dexel::Stats take_stats() { return std::exchange(stats_, {}); }

 private:
  struct Work {  // one tile and its steps in the batch
    std::size_t tile, begin, end;
    TileResult done;
  };

  void add(std::span<const ConvexGroup> cutter, const Pose& from, const Pose& to, std::uint32_t move);
  bool full() const;
  void flush();
  void cut_steps();
  void open_tiles();
  void assign();
  void sort_pairs(std::size_t first, std::size_t last);
  void cut_tile(Work& work) const;
  void collect(Work& w);

  dexel::Grid& grid_;
  bool measured_;
  const CarveOptions& options_;
  Cut& cut_;
  Rollback* rollback_;
  GridRegion* region_ = nullptr;
  std::deque<Motion> motions_;  // of the batch, in the grid's cyclic frame; steps point to them
  base::BlockVector<Step> steps_;
  base::BlockVector<std::pair<std::size_t, std::size_t>> pairs_, sorted_;  // (tile, step)
  base::BlockVector<std::uint32_t> starts_;
  base::BlockVector<Work> work_;
  dexel::Stats stats_;
};

}  // namespace riffler::sweep
