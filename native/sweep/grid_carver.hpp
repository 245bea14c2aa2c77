// Carves one grid with the moves of a tool, in batches.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "riffler/base/block_pool.hpp"
#include "riffler/dexel/grid.hpp"
#include "riffler/dexel/stats.hpp"
#include "riffler/sweep/carve_options.hpp"
#include "sweep/cut_region.hpp"
#include "sweep/hull_steps.hpp"
#include "sweep/open_tiles.hpp"
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

  /// Cuts only some tiles of a block of at most 8 × 8: that in row a, column b of the block if bit 8 a + b is set. The
  /// result in these tiles is that of a run without a limit.
  void limit_to(const TileBlock& block, std::uint64_t tiles) { limit_ = {block, tiles}; }

  /// Keeps tiles open between runs; the grid has the result after `pack`. Only for moves in real time, without region.
  /// `size`: mm, the tool's; asks for the memory of as many tiles as it covers.
  void keep_open(double size);

  /// Sweeps the convex groups of a tool of revolution along `Pose`s, or the bodies of a hand tool along `RolledPose`s.
  /// Move m of `moves` goes to poses[end(m)] from the pose before it. Holds only one batch in memory, regardless of the
  /// length of the program.
  template <class Body, class AnyPose, class End, class Done>
  void run(std::span<const Body> cutter, std::span<const AnyPose> poses, std::size_t moves, const End& end,
           const Done& moves_done) {
    begin_run();
    AnyPose from;
    std::size_t last = 0;
    for (std::size_t m = 0; m < moves; ++m) {
      const std::size_t e = end(m);
      if (m == 0 || last != e - 1) from = to_local(grid_.axis(), poses[e - 1]);
      last = e;
      const AnyPose to = to_local(grid_.axis(), poses[e]);
      add(cutter, from, to, static_cast<std::uint32_t>(m));
      if (full()) flush(), moves_done(m);
      from = to;
    }
    flush();
  }

  /// With keep_open: whether runs only note their steps, and `advance` cuts with them. For a grid that nothing is
  /// measured in. A move that covers very many rays is cut at once, in all threads.
  void put_off(bool yes) { puts_off_ = yes; }
  /// Whether steps were put off that are not cut yet.
  bool behind() const { return next_ < work_.size() || cut_steps_ < steps_.size(); }
  /// Cuts a part of what was put off: with the steps of some eight moves in nearly as many calls, so that all calls
  /// take about as long.
  void advance();
  /// From now on, `advance` also packs what it cuts, and leaves alone what later runs put off.
  void begin_publish();
  /// Whether `advance` has still to pack something.
  bool publishing() const { return publishing_; }
  /// Whether there are so many steps that all must be packed.
  bool full() const;

  /// With keep_open: gives the grid what runs have cut from open tiles, after cutting what was put off. Tiles that the
  /// last run did not look at are closed.
  void pack();
  /// Same for a few tiles that the tool has left.
  void pack_left();
  /// Closes open tiles without packing them.
  void forget();
  /// Whether the last run has cut something.
  bool cut_something() const { return cut_something_; }

  dexel::Stats take_stats() { return std::exchange(stats_, {}); }

 private:
  struct Work {  // one tile and its steps in the batch
    std::size_t tile, begin, end;
    OpenTile* rays;  // null: opened for this batch only
    TileResult done;
    std::shared_ptr<const dexel::Tile> packed;
    bool packs = false;                 // after its last step
    std::size_t first = 0, tested = 0;  // where `begin` was in plan(), and rays tested since
  };
  // Time that a step of a tile and its packing take, in rays tested that take as long.
  static constexpr std::size_t kStepCost = 100, kPackCost = 1000;

  void begin_run();
  void add(std::span<const ConvexGroup> cutter, const Pose& from, const Pose& to, std::uint32_t move);
  void add(std::span<const tool::Hull> hulls, const RolledPose& from, const RolledPose& to, std::uint32_t move);
  void flush();
  void cut_steps();
  TileBlock limited(const TileBlock& under) const;
  bool is_limited(int row, int column) const;
  double rays(std::size_t first_step) const;
  void open_tiles();
  void assign();
  void sort_pairs(std::size_t first, std::size_t last);
  bool may_touch(const Work& work) const;
  void cut_tile(Work& work) const;
  void cut_open(Work& work, OpenTile& rays) const;
  std::shared_ptr<const dexel::Tile> packed(OpenTile& rays, std::size_t tile) const;
  void replace(std::size_t tile, std::shared_ptr<const dexel::Tile> packed);
  void pack(std::size_t entry);
  void plan(bool publish);
  void plan_tiles_without_steps();
  std::size_t advance(Work& work);
  void end_publish();
  void drop_steps();
  void collect(Work& w);

  dexel::Grid& grid_;
  bool measured_;
  const CarveOptions& options_;
  Cut& cut_;
  Rollback* rollback_;
  GridRegion* region_ = nullptr;
  std::optional<std::pair<TileBlock, std::uint64_t>> limit_;
  std::deque<Motion, base::BlockAllocator<Motion>>
      motions_;  // of the batch, in the grid's cyclic frame; steps point to them
  std::deque<RolledMotion, base::BlockAllocator<RolledMotion>> rolled_;  // same, of hand tools
  base::BlockVector<Step> steps_;
  std::size_t cut_steps_ = 0;  // those of the batch that are cut already, or in `work_`
  std::size_t run_steps_ = 0;  // those before the last run
  bool keeps_ = false, cut_something_ = false;
  bool puts_off_ = false, publishing_ = false;
  std::size_t next_ = 0;                    // index in `work_` of the first tile that is not done
  std::size_t budget_ = 0, overspent_ = 0;  // cost of a call of `advance`
  std::size_t published_motions_ = 0;       // those that end_publish drops
  std::uint64_t run_ = 0, planned_ = 0;     // numbers of the last run, and of that before the round
  OpenTiles open_;
  base::BlockVector<std::pair<std::size_t, std::size_t>> pairs_, sorted_;  // (tile, step)
  base::BlockVector<std::uint32_t> starts_;
  base::BlockVector<Work> work_;
  dexel::Stats stats_;
};

}  // namespace riffler::sweep
