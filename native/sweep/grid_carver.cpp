#include "sweep/grid_carver.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "riffler/base/parallel.hpp"

namespace riffler::sweep {

namespace {

/// Number of steps per batch: enough to occupy all threads, few enough to stay in the cache.
constexpr std::size_t kBatch = 512;
/// Number of rays below which starting threads costs more than it gains.
constexpr double kSerialRays = 1e5;

}  // namespace

void GridCarver::add(std::span<const ConvexGroup> cutter, const Pose& from, const Pose& to, std::uint32_t move) {
  const Motion& motion = motions_.emplace_back(from, to);
  for_each_step(cutter, motion, move, grid_.box(), options_.tolerance,
                [this](Step&& step) { steps_.push_back(std::move(step)); });
}

bool GridCarver::full() const {
  return steps_.size() >= kBatch || motions_.size() >= kBatch;
}

void GridCarver::flush() {
  if (!steps_.empty()) cut_steps();
  stats_.steps += steps_.size();
  steps_.clear(), motions_.clear();
}

void GridCarver::cut_steps() {
  assign();
  if (region_) open_tiles();
  double rays = 0;
  for (const Step& s : steps_) rays += s.footprint.rows().length() * s.footprint.columns().length();
  rays /= grid_.pitch() * grid_.pitch();
  const auto body = [this](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) cut_tile(work_[k]);
  };
  if (rays < kSerialRays)
    body(0, work_.size());
  else
    base::parallel_for(work_.size(), 1, body);
  for (Work& w : work_) collect(w);
  work_.clear();
}

/// Opens the region's tiles of this batch that no earlier batch opened.
void GridCarver::open_tiles() {
  std::vector<std::size_t> tiles;
  for (const Work& w : work_)
    if (!region_->opened(w.tile)) tiles.push_back(w.tile);
  region_->open(tiles);
}

/// Lists the batch's tiles with the steps that may touch them, both ascending.
void GridCarver::assign() {
  pairs_.clear(), work_.clear();
  std::size_t first = std::numeric_limits<std::size_t>::max(), last = 0;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const TileBlock under = tiles_under(grid_, steps_[k].footprint);
    if (under.empty()) continue;
    for (int a = under.row; a <= under.last_row; ++a)
      for (int b = under.column; b <= under.last_column; ++b) pairs_.emplace_back(grid_.tile_index(a, b), k);
    first = std::min(first, grid_.tile_index(under.row, under.column));
    last = std::max(last, grid_.tile_index(under.last_row, under.last_column));
  }
  sort_pairs(first, last);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (work_.empty() || work_.back().tile != pairs_[k].first) work_.push_back({pairs_[k].first, k, k, {}});
    work_.back().end = k + 1;
  }
}

/// Sorts by tile, from `first` to `last`; steps ascend already. Uses a counting sort if there are many pairs for that
/// range: short moves pass over the same few tiles again and again.
void GridCarver::sort_pairs(std::size_t first, std::size_t last) {
  if (pairs_.empty()) return;
  if (last - first > 2 * pairs_.size()) {
    std::sort(pairs_.begin(), pairs_.end());
    return;
  }
  starts_.assign(last - first + 2, 0);
  for (const auto& pair : pairs_) ++starts_[pair.first - first + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  sorted_.resize(pairs_.size());
  for (const auto& pair : pairs_) sorted_[starts_[pair.first - first]++] = pair;
  pairs_.swap(sorted_);
}

/// Cuts one tile with its steps of the batch.
void GridCarver::cut_tile(Work& work) const {
  const dexel::Tile& tile = grid_.tile(work.tile);
  if (tile.spans.empty()) return;
  std::optional<TileCutter> cutter;
  for (std::size_t k = work.begin; k < work.end; ++k) {
    const Step& step = steps_[pairs_[k].second];
    const Interval& height = step.footprint.height();
    if (!(tile.reach.near < height.far && tile.reach.far > height.near)) continue;  // the tool stays above or below
    if (!cutter) cutter.emplace(grid_, work.tile, measured_, options_);
    cutter->cut(step);
  }
  if (cutter) work.done = cutter->finish();
}

void GridCarver::collect(Work& w) {
  stats_ += w.done.stats;
  for (const Share& s : w.done.shares) {
    cut_.removed[s.move] += s.removed;
    cut_.force[s.move] += to_world(grid_.axis(), s.force);
    cut_.torque[s.move] += to_world(grid_.axis(), s.torque);
  }
  if (!w.done.tile) return;
  if (rollback_) rollback_->keep(grid_, w.tile);
  grid_.set_tile(w.tile, std::move(w.done.tile));
}

}  // namespace riffler::sweep
