#include "sweep/grid_carver.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>

#include "riffler/base/parallel.hpp"
#include "sweep/tile_normals.hpp"

namespace riffler::sweep {

namespace {

/// Number of steps per batch: enough to occupy all threads, few enough to stay in the cache.
constexpr std::size_t kBatch = 512;
/// Number of rays below which starting threads costs more than it gains.
constexpr double kSerialRays = 1e5;

/// Whether a tool at these heights does not stay above or below a tile's material.
bool meets(const dexel::Tile& tile, const Interval& heights) {
  return tile.reach.near < heights.far && tile.reach.far > heights.near;
}

}  // namespace

void GridCarver::add(std::span<const ConvexGroup> cutter, const Pose& from, const Pose& to, std::uint32_t move) {
  const Motion& motion = motions_.emplace_back(from, to);
  for_each_step(cutter, motion, move, grid_.box(), options_.tolerance,
                [this](Step&& step) { steps_.push_back(std::move(step)); });
}

bool GridCarver::full() const {
  return steps_.size() >= kBatch || motions_.size() >= kBatch;
}

void GridCarver::keep_open(double size) {
  const auto tiles = [&](int all) {
    return std::min(all, 2 + static_cast<int>(size / (grid_.pitch() * dexel::kTileSide)));
  };
  const int most = grid_.has_normals() ? 48 : 128;  // some 10 MB
  open_.reserve(grid_, static_cast<std::size_t>(std::min(tiles(grid_.tiles_u()) * tiles(grid_.tiles_v()), most)));
  steps_.reserve(2 * kBatch);
  keeps_ = true;
}

void GridCarver::begin_run() {
  ++run_;
  cut_something_ = false;
  if (!keeps_) steps_.clear(), motions_.clear();  // left over from a run that failed
  cut_steps_ = steps_.size();
}

void GridCarver::flush() {
  if (cut_steps_ < steps_.size()) cut_steps();
  stats_.steps += steps_.size() - cut_steps_;
  cut_steps_ = steps_.size();
  if (!keeps_ || full()) pack();
}

void GridCarver::cut_steps() {
  assign();
  if (region_) open_tiles();
  double rays = 0;
  for (std::size_t k = cut_steps_; k < steps_.size(); ++k)
    rays += steps_[k].footprint.rows().length() * steps_[k].footprint.columns().length();
  rays /= grid_.pitch() * grid_.pitch();
  if (keeps_)
    for (Work& w : work_)
      if (may_touch(w)) w.rays = &open_.open(grid_, w.tile, run_);
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
  for (std::size_t k = cut_steps_; k < steps_.size(); ++k) {
    const TileBlock under = tiles_under(grid_, steps_[k].footprint);
    if (under.empty()) continue;
    for (int a = under.row; a <= under.last_row; ++a)
      for (int b = under.column; b <= under.last_column; ++b) pairs_.emplace_back(grid_.tile_index(a, b), k);
    first = std::min(first, grid_.tile_index(under.row, under.column));
    last = std::max(last, grid_.tile_index(under.last_row, under.last_column));
  }
  sort_pairs(first, last);
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    if (work_.empty() || work_.back().tile != pairs_[k].first)
      work_.push_back({pairs_[k].first, k, k, nullptr, {}, {}});
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

bool GridCarver::may_touch(const Work& work) const {
  for (std::size_t k = work.begin; k < work.end; ++k)
    if (meets(grid_.tile(work.tile), steps_[pairs_[k].second].footprint.height())) return true;
  return false;
}

/// Cuts one tile with its steps of the batch.
void GridCarver::cut_tile(Work& work) const {
  if (work.rays) return cut_open(work, *work.rays);
  if (keeps_ || !may_touch(work)) return;
  thread_local OpenTile rays;
  rays.begin(grid_, work.tile);
  cut_open(work, rays);
  if (rays.changed()) work.packed = packed(rays, work.tile);
  rays.end();
}

void GridCarver::cut_open(Work& work, OpenTile& rays) const {
  std::optional<TileCutter> cutter;
  for (std::size_t k = work.begin; k < work.end; ++k) {
    const std::size_t number = pairs_[k].second;
    const Step& step = steps_[number];
    if (!meets(grid_.tile(work.tile), step.footprint.height())) continue;
    if (!cutter) cutter.emplace(grid_, work.tile, rays, measured_, options_);
    cutter->cut(step, number);
  }
  if (cutter) work.done = cutter->finish();
}

void GridCarver::collect(Work& w) {
  stats_ += w.done.stats;
  cut_something_ = cut_something_ || w.done.stats.rays_changed > 0;
  for (const Share& s : w.done.shares) {
    cut_.removed[s.move] += s.removed;
    cut_.force[s.move] += to_world(grid_.axis(), s.force);
    cut_.torque[s.move] += to_world(grid_.axis(), s.torque);
  }
  if (w.packed) replace(w.tile, std::move(w.packed));
}

std::shared_ptr<const dexel::Tile> GridCarver::packed(OpenTile& rays, std::size_t tile) const {
  store_normals(rays, grid_, tile, {steps_.data(), steps_.size()});
  return rays.pack();
}

void GridCarver::replace(std::size_t tile, std::shared_ptr<const dexel::Tile> packed) {
  stats_.tiles_changed += 1, stats_.bytes_copied += packed->nbytes();
  if (rollback_) rollback_->keep(grid_, tile);
  grid_.set_tile(tile, std::move(packed));
}

void GridCarver::pack(std::size_t entry) {
  OpenTiles::Entry& e = open_.entry(entry);
  if (e.rays->changed()) replace(e.tile, packed(*e.rays, e.tile));
  if (e.used != run_) open_.close(entry);
}

void GridCarver::pack() {
  for (std::size_t k = open_.entries().size(); k-- > 0;) pack(k);
  steps_.clear(), motions_.clear();
  cut_steps_ = 0;
}

void GridCarver::pack_left() {
  constexpr std::uint64_t kLeft = 4;  // runs; a hand that trembles comes back
  constexpr int kMost = 2;            // so that no move has to wait long
  int packed = 0;
  for (std::size_t k = open_.entries().size(); k-- > 0 && packed < kMost;)
    if (open_.entries()[k].used + kLeft < run_) pack(k), ++packed;
}

void GridCarver::forget() {
  open_.clear();
  steps_.clear(), motions_.clear();
  cut_steps_ = 0;
}

}  // namespace riffler::sweep
