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

void GridCarver::add(std::span<const tool::Hull> hulls, const RolledPose& from, const RolledPose& to,
                     std::uint32_t move) {
  const RolledMotion& motion = rolled_.emplace_back(from, to);
  for_each_step(hulls, motion, move, grid_.box(), options_.tolerance,
                [this](Step&& step) { steps_.push_back(std::move(step)); });
}

bool GridCarver::full() const {
  return steps_.size() >= kBatch || motions_.size() >= kBatch || rolled_.size() >= kBatch;
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
  if (!keeps_) drop_steps();  // left over from a run that failed
  run_steps_ = steps_.size();
}

void GridCarver::flush() {
  if (puts_off_ && rays(run_steps_) < kSerialRays) return;
  cut_steps();
  if (!keeps_) pack();
}

/// Number of rays under the steps from this one on.
double GridCarver::rays(std::size_t first_step) const {
  double area = 0;
  for (std::size_t k = first_step; k < steps_.size(); ++k)
    area += steps_[k].footprint.rows().length() * steps_[k].footprint.columns().length();
  return area / (grid_.pitch() * grid_.pitch());
}

void GridCarver::cut_steps() {
  if (!behind()) return;
  const double many = rays(cut_steps_);
  assign();
  if (region_) open_tiles();
  if (keeps_)
    for (Work& w : work_)
      if (may_touch(w)) w.rays = &open_.open(grid_, w.tile, run_);
  const auto body = [this](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) cut_tile(work_[k]);
  };
  if (many < kSerialRays)
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

/// The part of a block that the carver may cut.
TileBlock GridCarver::limited(const TileBlock& under) const {
  if (!limit_) return under;
  const TileBlock& to = limit_->first;
  return {std::max(under.row, to.row), std::min(under.last_row, to.last_row), std::max(under.column, to.column),
          std::min(under.last_column, to.last_column)};
}

/// Whether the carver must not cut this tile of that part.
bool GridCarver::is_limited(int row, int column) const {
  if (!limit_) return false;
  const auto& [block, tiles] = *limit_;
  return (tiles >> (8 * (row - block.row) + column - block.column) & 1) == 0;
}

/// Lists the batch's tiles with the steps that may touch them, both ascending: new steps, and what is left of earlier
/// ones.
void GridCarver::assign() {
  std::size_t first = std::numeric_limits<std::size_t>::max(), last = 0, left = 0;
  for (; next_ < work_.size(); ++next_) {
    const Work& w = work_[next_];
    std::copy(pairs_.begin() + w.begin, pairs_.begin() + w.end, pairs_.begin() + left);
    left += w.end - w.begin;
  }
  pairs_.resize(left);
  work_.clear(), next_ = 0;
  if (left > 0) first = pairs_.front().first, last = pairs_.back().first;
  for (std::size_t k = cut_steps_; k < steps_.size(); ++k) {
    const TileBlock under = limited(tiles_under(grid_, steps_[k].footprint));
    if (under.empty()) continue;
    for (int a = under.row; a <= under.last_row; ++a)
      for (int b = under.column; b <= under.last_column; ++b)
        if (!is_limited(a, b)) pairs_.emplace_back(grid_.tile_index(a, b), k);
    first = std::min(first, grid_.tile_index(under.row, under.column));
    last = std::max(last, grid_.tile_index(under.last_row, under.last_column));
  }
  stats_.steps += steps_.size() - cut_steps_;
  cut_steps_ = steps_.size();
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
  cut_steps();
  for (std::size_t k = open_.entries().size(); k-- > 0;) pack(k);
  drop_steps();
}

void GridCarver::drop_steps() {
  steps_.clear(), motions_.clear(), rolled_.clear(), work_.clear();
  cut_steps_ = next_ = 0;
  publishing_ = false;
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
  drop_steps();
}

/// Begins a round of calls of `advance` with all steps so far. Where the tool will find material is not known, but
/// all tiles together mostly cost as much as in the round before. A round has a few calls less than moves, so that
/// publishing, which also packs, finds less to cut.
void GridCarver::plan(bool publish) {
  constexpr std::uint64_t kRound = 6, kMost = 16, kPublish = 16;  // calls
  constexpr std::size_t kLeast = 2500;                            // a call's budget, at least
  assign();
  plan_tiles_without_steps();
  std::size_t cost = 0;
  for (Work& w : work_) {
    w.first = w.begin, w.tested = 0;
    w.packs = publish || w.begin == w.end;
    const std::size_t tested = open_.is_open(w.tile) ? open_.entry(open_.index(w.tile)).tested : 0;
    cost += (w.end - w.begin) * (kStepCost + tested) + (w.packs ? kPackCost : 0);
  }
  budget_ = std::max(kLeast, cost / (publish ? kPublish : std::clamp((run_ - planned_) * 4 / 5, kRound, kMost)));
  planned_ = run_;
}

/// Tiles that the tool has left are packed, too.
void GridCarver::plan_tiles_without_steps() {
  const std::size_t count = work_.size();
  for (const OpenTiles::Entry& e : open_.entries()) {
    const auto before = [](const Work& w, std::size_t tile) { return w.tile < tile; };
    const auto end = work_.begin() + count, at = std::lower_bound(work_.begin(), end, e.tile, before);
    if (at == end || at->tile != e.tile) work_.push_back({e.tile, 0, 0, nullptr, {}, {}});
  }
}

void GridCarver::advance() {
  if (next_ == work_.size() && !publishing_) plan(false);
  std::size_t spent = std::exchange(overspent_, 0);
  while (next_ < work_.size() && spent < budget_) {
    Work& w = work_[next_];
    spent += advance(w);
    if (w.begin == w.end) ++next_;
  }
  if (spent > budget_) overspent_ = std::min(spent - budget_, budget_ / 2);
  if (publishing_ && next_ == work_.size()) end_publish();
}

/// Cuts one tile with the next steps of its work, and packs it after the last one if the grid is to have it. Returns
/// the cost.
std::size_t GridCarver::advance(Work& work) {
  constexpr std::size_t kSteps = 2;
  const bool left = work.begin == work.end;
  Work now{work.tile, work.begin, std::min(work.begin + kSteps, work.end), nullptr, {}, {}};
  std::size_t cost = 0;
  if (may_touch(now)) {
    now.rays = &open_.open(grid_, now.tile, run_);
    cut_tile(now);
    work.tested += now.done.stats.rays_tested;
    cost += (now.end - now.begin) * kStepCost + now.done.stats.rays_tested;
    collect(now);
  }
  work.begin = now.end;
  if (work.begin < work.end || !open_.is_open(work.tile)) return cost;
  const std::size_t index = open_.index(work.tile);
  OpenTiles::Entry& entry = open_.entry(index);
  if (!left) entry.tested = work.tested / (work.end - work.first);
  if (work.packs && entry.rays->changed()) replace(work.tile, packed(*entry.rays, work.tile)), cost += kPackCost;
  if (left) open_.close(index);
  return cost;
}

void GridCarver::begin_publish() {
  plan(true);
  publishing_ = true;
  published_motions_ = motions_.size();
  if (work_.empty()) end_publish();
}

/// Every normal of the steps that are cut is stored; those that were put off since become the first.
void GridCarver::end_publish() {
  publishing_ = false;
  work_.clear(), next_ = 0;
  steps_.erase(steps_.begin(), steps_.begin() + cut_steps_);
  motions_.erase(motions_.begin(), motions_.begin() + published_motions_);
  cut_steps_ = 0;
}

}  // namespace riffler::sweep
