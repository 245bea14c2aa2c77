#include "sweep/history_run.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "base/sort_unique.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/dexel/boolean.hpp"
#include "sweep/cut_region.hpp"
#include "sweep/grid_carver.hpp"

namespace riffler::sweep {

namespace {

using TilePtr = std::shared_ptr<const dexel::Tile>;

/// Tiles along a side of the block that one thread carves: few enough that an edit occupies several threads, enough
/// that moves are split into steps only a few times.
constexpr int kBlockSide = 4;

int row_of(const dexel::Grid& grid, std::size_t tile) {
  return static_cast<int>(tile) / grid.tiles_v();
}

int column_of(const dexel::Grid& grid, std::size_t tile) {
  return static_cast<int>(tile) % grid.tiles_v();
}

/// The block that a tile is in.
TileBlock block_of(const dexel::Grid& grid, std::size_t tile) {
  const int row = row_of(grid, tile) / kBlockSide * kBlockSide,
            column = column_of(grid, tile) / kBlockSide * kBlockSide;
  return {row, row + kBlockSide - 1, column, column + kBlockSide - 1};
}

/// The ends (carve_moves.hpp) of the moves that touch some of the tiles.
std::vector<std::uint32_t> ends_of(const TouchedTiles& touched, std::span<TileRerun* const> tiles) {
  std::vector<MoveRun> runs;
  for (const TileRerun* t : tiles) {
    const auto of_tile = touched.of(touched.index(t->tile));
    runs.insert(runs.end(), of_tile.begin(), of_tile.end());
  }
  std::ranges::sort(runs, {}, &MoveRun::first);
  std::vector<std::uint32_t> ends;
  for (const MoveRun& run : runs)
    for (std::uint32_t m = std::max(run.first, ends.empty() ? 0 : ends.back()); m < run.end; ++m) ends.push_back(m + 1);
  return ends;
}

}  // namespace

/// A stroke that comes to a tile.
struct HistoryRun::Visit {
  std::size_t key, tile;
  const PreparedStroke* stroke;
};

void HistoryScratch::fill_boxes(const Volume& base) {
  if (!boxes.empty()) return;
  std::vector<dexel::Grid> filled = base.grids();
  for (dexel::Grid& grid : filled) grid.fill();
  boxes = std::move(filled);
}

HistoryRun::HistoryRun(const Volume& base, const std::vector<std::vector<TileVersions>>& versions,
                       HistoryScratch& scratch, const HistoryEdit& edit, std::size_t stride)
    : base_(base), versions_(versions), scratch_(scratch), edit_(edit), stride_(stride) {
  for (std::size_t g = 0; g < base.grids().size(); ++g) list_tiles(g);
}

/// The scratch memory holds no tile of this run afterwards.
HistoryRun::~HistoryRun() {
  for (const TileRerun& t : tiles_) scratch_.work[t.grid].set_tile(t.tile, base_.grids()[t.grid].shared_tile(t.tile));
}

/// Lists the tiles of a grid that the edited stroke touches, before or after the edit.
void HistoryRun::list_tiles(std::size_t grid) {
  const std::vector<std::uint32_t> none;
  const auto& out = edit_.out ? edit_.out->touched[grid].tiles : none;
  const auto& in = edit_.in ? edit_.in->touched[grid].tiles : none;
  for (std::size_t a = 0, b = 0; a < out.size() || b < in.size();) {
    const bool leaves = a < out.size() && (b == in.size() || out[a] <= in[b]);
    const bool enters = b < in.size() && (a == out.size() || in[b] <= out[a]);
    begin(grid, leaves ? out[a] : in[b], leaves ? edit_.out : nullptr, enters ? edit_.in : nullptr);
    a += leaves, b += enters;
  }
}

/// Lists the new versions of a tile, which are still without content.
void HistoryRun::begin(std::size_t grid, std::size_t tile, const PreparedStroke* out, const PreparedStroke* in) {
  const TileVersions& old = versions_[grid][tile];
  const auto place = [&](std::size_t rank) {
    const auto before = [](const TileVersion& v, std::size_t r) { return v.stroke->rank < r; };
    return static_cast<std::size_t>(std::lower_bound(old.begin(), old.end(), rank, before) - old.begin());
  };
  const std::size_t leaves = out ? place(out->rank) : old.size(), enters = in ? place(edit_.at) : old.size();
  if (out == in && (enters == leaves || enters == leaves + 1)) return;  // moved, but not across a stroke of this tile
  TileRerun t{grid, tile, std::min(leaves, enters), {}, nullptr, false, 0, 0, 0, 0};
  for (std::size_t k = t.first; k <= old.size(); ++k) {
    if (in && k == enters) t.tail.push_back({in, nullptr});
    if (k < old.size() && !(out && k == leaves)) t.tail.push_back({old[k].stroke, nullptr});
  }
  t.common = std::max(out ? leaves + 1 : 0, in ? enters : 0);
  t.shift = (in ? 1 : 0) - (out ? 1 : 0);
  t.restored = t.first < old.size();
  t.next = t.first;
  while (t.next > 0 && !old[t.next - 1].tile) --t.next;
  t.kept = t.next;
  t.last = t.next > 0 ? old[t.next - 1].tile : base_.grids()[grid].shared_tile(tile);
  tiles_.push_back(std::move(t));
}

/// Number k in the new order of a tile.
const PreparedStroke& HistoryRun::stroke_at(const TileRerun& t, std::size_t k) const {
  return k < t.first ? *versions_[t.grid][t.tile][k].stroke : *t.tail[k - t.first].stroke;
}

/// Sorts strokes by the new order.
std::size_t HistoryRun::key(const PreparedStroke& stroke) const {
  return &stroke == edit_.in ? 2 * edit_.at : 2 * stroke.rank + 1;
}

/// The tile before number k of the old order; null if it is not kept.
const TilePtr& HistoryRun::before(const TileRerun& t, std::size_t k) const {
  return k > 0 ? versions_[t.grid][t.tile][k - 1].tile : base_.grids()[t.grid].shared_tile(t.tile);
}

/// Ends the run of a tile that has the content that it had before at this place of the order. Later versions stay then.
bool HistoryRun::rejoin(TileRerun& t) const {
  const auto at = static_cast<std::ptrdiff_t>(t.next) - t.shift;
  if (at < static_cast<std::ptrdiff_t>(t.common)) return false;
  const auto old_at = static_cast<std::size_t>(at);
  const TileVersions& old = versions_[t.grid][t.tile];
  const TilePtr& known = before(t, old_at);
  if (!known || !same_bytes(*known, *t.last)) return false;
  if (t.next > t.first) t.tail[t.next - t.first - 1].tile = known;
  if (t.next == t.first) t.restored = false;
  for (std::size_t k = old_at; k < old.size(); ++k) t.tail[t.next - t.first + (k - old_at)].tile = old[k].tile;
  t.last = old_at < old.size() ? old.back().tile : known;
  return t.done = true;
}

/// Keeps the tile that stroke number `next` has left, unless the stride omits it.
void HistoryRun::keep(TileRerun& t) const {
  const std::size_t k = t.next++;
  if (k < t.first || (t.next - t.kept < stride_ && k + 1 < t.first + t.tail.size())) return;
  t.tail[k - t.first].tile = t.last;
  t.kept = t.next;
}

/// Groups tiles by blocks of the grid.
std::vector<HistoryRun::Unit> HistoryRun::units() const {
  std::map<std::tuple<std::size_t, int, int>, Unit> blocks;
  for (std::size_t k = 0; k < tiles_.size(); ++k) {
    const TileBlock block = block_of(base_.grids()[tiles_[k].grid], tiles_[k].tile);
    blocks[{tiles_[k].grid, block.row, block.column}].push_back(k);
  }
  std::vector<Unit> out;
  for (auto& [place, unit] : blocks) out.push_back(std::move(unit));
  return out;
}

/// Whether there is so little to carve that starting threads costs more than it gains.
bool HistoryRun::small() const {
  constexpr std::size_t kMoves = 400;  // (move, tile) pairs
  std::size_t moves = 0;
  for (const TileRerun& t : tiles_)
    for (std::size_t k = t.next; k < t.first + t.tail.size(); ++k) {
      const TouchedTiles& touched = stroke_at(t, k).touched[t.grid];
      for (const MoveRun& run : touched.of(touched.index(t.tile))) moves += run.end - run.first;
      if (moves > kMoves) return false;
    }
  return true;
}

/// Takes the tiles of one unit through their strokes. Returns the keys of the strokes that carved something.
std::vector<std::size_t> HistoryRun::run_unit(const Unit& unit, HistoryRunStats& stats) {
  std::vector<Visit> visits;
  for (const std::size_t n : unit) {
    const TileRerun& t = tiles_[n];
    for (std::size_t k = t.next; k < t.first + t.tail.size(); ++k) {
      const PreparedStroke& stroke = stroke_at(t, k);
      visits.push_back({key(stroke), n, &stroke});
    }
  }
  std::ranges::sort(visits, {}, [](const Visit& v) { return std::pair(v.key, v.tile); });
  std::vector<std::size_t> keys;
  std::vector<TileRerun*> now;
  for (std::size_t begin = 0, end = 0; begin < visits.size(); begin = end) {
    now.clear();
    for (; end < visits.size() && visits[end].key == visits[begin].key; ++end) {
      TileRerun& t = tiles_[visits[end].tile];
      if (!t.done && !rejoin(t)) now.push_back(&t);
    }
    if (now.empty()) continue;
    carve(*visits[begin].stroke, now, stats);
    keys.push_back(visits[begin].key);
    for (TileRerun* t : now) keep(*t);
    base::still_wanted();
  }
  for (const std::size_t n : unit)
    if (!tiles_[n].done) rejoin(tiles_[n]);  // keeps the old tile if its content is the same
  return keys;
}

/// What a stroke cuts of a tile; for a plain carve, all of it.
TilePtr HistoryRun::cuttable(const PreparedStroke& stroke, const TileRerun& t, dexel::TileBuilder& builder) const {
  const dexel::Grid& grid = base_.grids()[t.grid];
  TilePtr tile = t.last;
  if (stroke.stroke.mode == CarveMode::Add)
    tile = apply(dexel::Boolean::Subtract, grid, t.tile, scratch_.boxes[t.grid].shared_tile(t.tile), tile, builder);
  if (stroke.stroke.protect)
    tile = apply(dexel::Boolean::Subtract, grid, t.tile, tile,
                 stroke.stroke.protect->grids()[t.grid].shared_tile(t.tile), builder);
  return tile;
}

/// Carves a stroke into tiles of one block.
void HistoryRun::carve(const PreparedStroke& stroke, std::span<TileRerun* const> tiles, HistoryRunStats& stats) {
  const std::size_t g = tiles.front()->grid;
  dexel::Grid& work = scratch_.work[g];
  const HistoryStroke& s = stroke.stroke;
  const TileBlock block = block_of(work, tiles.front()->tile);
  dexel::TileBuilder builder(work.has_normals());
  std::vector<TilePtr> before;
  std::uint64_t limit = 0;
  for (TileRerun* t : tiles) {
    before.push_back(cuttable(stroke, *t, builder));
    work.set_tile(t->tile, before.back());
    limit |= std::uint64_t{1} << (8 * (row_of(work, t->tile) - block.row) + column_of(work, t->tile) - block.column);
  }
  const std::vector<std::uint32_t> ends = ends_of(stroke.touched[g], tiles);
  CarveOptions options;
  options.tolerance = s.tolerance;
  Cut unmeasured;
  GridCarver carver(work, false, options, unmeasured, nullptr);
  carver.limit_to(block, limit);
  const auto end = [&](std::size_t m) { return ends[m]; };
  const auto done = [](std::size_t) { base::still_wanted(); };
  if (s.tool.revolved())
    carver.run(std::span(stroke.cutter), std::span(s.poses), ends.size(), end, done);
  else
    carver.run(std::span(s.tool.hulls()), std::span(s.rolled), ends.size(), end, done);
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    TileRerun& t = *tiles[k];
    const TilePtr& rest = work.shared_tile(t.tile);
    const bool composed = s.mode == CarveMode::Add || s.protect;
    t.last = composed ? composite_tile(s.mode, work, t.tile, t.last, before[k], rest, builder) : rest;
  }
  stats.tiles += tiles.size(), stats.moves += ends.size();
}

void HistoryRun::run(const Progress& progress) {
  const std::vector<Unit> all = units();
  std::vector<std::vector<std::size_t>> keys(all.size());
  std::vector<HistoryRunStats> stats(all.size());
  std::optional<base::SerialScope> alone;
  if (small()) alone.emplace();
  base::parallel_for(
      all.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) keys[k] = run_unit(all[k], stats[k]);
      },
      progress);
  std::vector<std::size_t> carved;
  for (std::size_t k = 0; k < all.size(); ++k) {
    carved.insert(carved.end(), keys[k].begin(), keys[k].end());
    stats_.tiles += stats[k].tiles, stats_.moves += stats[k].moves;
  }
  base::sort_unique(carved);
  stats_.strokes = carved.size();
}

}  // namespace riffler::sweep
