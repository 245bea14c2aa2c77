#include "riffler/sweep/history.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "riffler/base/check.hpp"
#include "riffler/dexel/boolean.hpp"
#include "riffler/sweep/carve.hpp"
#include "sweep/history_run.hpp"

namespace riffler::sweep {

namespace {

/// Share of an edit's progress that finding the touched tiles takes.
constexpr double kPrepared = 0.1;

void check(const HistoryStroke& stroke, const Volume& base) {
  check_poses_suit(stroke.tool, stroke.poses.size(), stroke.rolled.size());
  const std::size_t rows = stroke.poses.size() + stroke.rolled.size();
  if (rows == 0) throw std::invalid_argument("poses: a stroke needs at least one pose");
  check_path(stroke.poses), check_path(stroke.rolled);
  base::require_tolerance(stroke.tolerance);
  base::require_tolerance_for(stroke.tolerance, std::max(stroke.tool.length(), stroke.tool.diameter()));
  if (stroke.protect) check_same_grid(base.frame(), stroke.protect->frame(), "protect");
  if (rows > UINT32_MAX) throw std::invalid_argument("poses: more than 4294967295 rows");
}

/// Makes room for `size` elements, and for more, so that growing one by one stays cheap.
template <class T>
void make_room(std::vector<T>& list, std::size_t size) {
  if (size > list.capacity()) list.reserve(std::max(size, 2 * list.capacity()));
}

}  // namespace

struct History::Core {
  struct Entry {
    std::unique_ptr<PreparedStroke> stroke;
    bool enabled = true;
  };

  Core(const Volume& volume, std::size_t limit);
  Entry& find(StrokeId id);
  std::string list() const;
  std::unique_ptr<PreparedStroke> prepare(StrokeId id, HistoryStroke&& stroke, const Progress& progress) const;
  StrokeId insert(HistoryStroke&& stroke, std::size_t rank, const Progress& progress);
  /// Carves the tiles that an edit touches, then calls `change`, which must not throw, and stores the result.
  template <class Change>
  void apply(const HistoryEdit& edit, const Progress& progress, const Change& change);
  void store(HistoryRun& run) noexcept;
  void number() noexcept;
  void limit_memory() noexcept;
  VersionCost cost(std::size_t grid, std::size_t tile, std::size_t from = 0) const {
    return cost_of(versions[grid][tile], &base.grids()[grid].tile(tile), from);
  }

  Volume base, now;
  std::size_t memory_limit;
  std::vector<Entry> order;
  std::unordered_map<StrokeId, std::size_t> ranks;
  std::vector<std::vector<TileVersions>> versions;  // by grid and tile
  HistoryScratch scratch;
  StrokeId next_id = 1;
  std::size_t held = 0;  // bytes of versions
  HistoryStats stats;
};

History::Core::Core(const Volume& volume, std::size_t limit)
    : base(volume), now(volume), memory_limit(limit), scratch(base) {
  base.take_stats(), now.take_stats();
  for (const dexel::Grid& grid : base.grids()) versions.emplace_back(grid.tile_count());
}

/// "1, 2, 3, …" for messages.
std::string History::Core::list() const {
  constexpr std::size_t kMax = 8;
  std::string out;
  for (std::size_t k = 0; k < std::min(order.size(), kMax); ++k)
    out += (k > 0 ? ", " : "") + std::to_string(order[k].stroke->id);
  return order.size() > kMax ? out + ", …" : out;
}

History::Core::Entry& History::Core::find(StrokeId id) {
  const auto found = ranks.find(id);
  if (found != ranks.end()) return order[found->second];
  throw std::invalid_argument("stroke " + std::to_string(id) + " is not in the history" +
                              (order.empty() ? ", which has no strokes" : "; its strokes are " + list()));
}

std::unique_ptr<PreparedStroke> History::Core::prepare(StrokeId id, HistoryStroke&& stroke,
                                                       const Progress& progress) const {
  check(stroke, base);
  auto out = std::make_unique<PreparedStroke>(PreparedStroke{id, std::move(stroke), {}, {}, 0});
  const HistoryStroke& s = out->stroke;
  if (s.tool.revolved()) out->cutter = convex_groups(s.tool.cutter());
  const auto grids = static_cast<double>(base.grids().size());
  for (std::size_t g = 0; g < base.grids().size(); ++g) {
    const double share = static_cast<double>(g) / grids;
    const Progress part = base::part(progress, kPrepared * share, kPrepared * (share + 1 / grids));
    const dexel::Grid& grid = base.grids()[g];
    out->touched.push_back(s.tool.revolved() ? touched_tiles(grid, out->cutter, s.poses, s.tolerance, part)
                                             : touched_tiles(grid, s.tool.hulls(), s.rolled, s.tolerance, part));
  }
  return out;
}

template <class Change>
void History::Core::apply(const HistoryEdit& edit, const Progress& progress, const Change& change) {
  if (edit.in && edit.in->stroke.mode == CarveMode::Add) scratch.fill_boxes(base);
  HistoryRun run(base, versions, scratch, edit, stats.stride);
  run.run(base::part(progress, kPrepared, 1));
  for (const TileRerun& t : run.tiles()) make_room(versions[t.grid][t.tile], t.first + t.tail.size());
  // Nothing below throws: the history changes as a whole or not at all.
  change();
  number();
  store(run);
}

/// Puts the result of a run in place of earlier versions.
void History::Core::store(HistoryRun& run) noexcept {
  stats.tiles_restored = stats.tiles_changed = 0;
  for (TileRerun& t : run.tiles()) {
    TileVersions& of_tile = versions[t.grid][t.tile];
    const std::size_t from = stats.stride > 1 ? 0 : t.first;  // a stride may drop earlier versions, too
    held -= cost(t.grid, t.tile, from).bytes;
    of_tile.resize(t.first);
    of_tile.insert(of_tile.end(), std::make_move_iterator(t.tail.begin()), std::make_move_iterator(t.tail.end()));
    if (!of_tile.empty()) of_tile.back().tile = t.last;
    if (stats.stride > 1) thin(of_tile, stats.stride);
    held += cost(t.grid, t.tile, from).bytes;
    stats.tiles_restored += t.restored;
    dexel::Grid& grid = now.grids()[t.grid];
    if (grid.shared_tile(t.tile) == t.last) continue;
    grid.set_tile(t.tile, std::move(t.last));
    ++stats.tiles_changed;
  }
  if (stats.tiles_changed > 0) now.touch();
  ++stats.edits;
  stats.strokes_run = run.stats().strokes, stats.tiles_run = run.stats().tiles, stats.moves_run = run.stats().moves;
  limit_memory();
}

void History::Core::number() noexcept {
  for (std::size_t k = 0; k < order.size(); ++k) {
    order[k].stroke->rank = k;
    ranks.find(order[k].stroke->id)->second = k;
  }
}

/// Keeps fewer versions of each tile while all together take more than the limit.
void History::Core::limit_memory() noexcept {
  if (held < memory_limit / 4 && stats.stride > 1) stats.stride /= 2;
  while (held > memory_limit && stats.stride < order.size()) {
    stats.stride *= 2;
    held = 0;
    for (std::size_t g = 0; g < versions.size(); ++g)
      for (std::size_t t = 0; t < versions[g].size(); ++t) {
        thin(versions[g][t], stats.stride);
        held += cost(g, t).bytes;
      }
  }
}

StrokeId History::Core::insert(HistoryStroke&& stroke, std::size_t rank, const Progress& progress) {
  std::unique_ptr<PreparedStroke> prepared = prepare(next_id, std::move(stroke), progress);
  make_room(order, order.size() + 1);
  const auto place = ranks.emplace(next_id, rank).first;
  try {
    apply({nullptr, prepared.get(), rank}, progress,
          [&] { order.insert(order.begin() + static_cast<std::ptrdiff_t>(rank), Entry{std::move(prepared), true}); });
  } catch (...) {
    ranks.erase(place);
    throw;
  }
  return next_id++;
}

History::History(const Volume& base, std::size_t memory_limit) : core_(std::make_unique<Core>(base, memory_limit)) {}
History::History(History&&) noexcept = default;
History& History::operator=(History&&) noexcept = default;
History::~History() = default;

StrokeId History::add(HistoryStroke stroke, const Progress& progress) {
  return core_->insert(std::move(stroke), core_->order.size(), progress);
}

StrokeId History::insert(HistoryStroke stroke, StrokeId before, const Progress& progress) {
  return core_->insert(std::move(stroke), core_->find(before).stroke->rank, progress);
}

void History::replace(StrokeId id, HistoryStroke stroke, const Progress& progress) {
  Core::Entry& entry = core_->find(id);
  std::unique_ptr<PreparedStroke> prepared = core_->prepare(id, std::move(stroke), progress);
  HistoryEdit edit;
  if (entry.enabled) edit = {entry.stroke.get(), prepared.get(), entry.stroke->rank};
  std::unique_ptr<PreparedStroke> old;  // versions refer to it until they are replaced
  core_->apply(edit, progress, [&] { old = std::exchange(entry.stroke, std::move(prepared)); });
}

void History::remove(StrokeId id, const Progress& progress) {
  Core::Entry& entry = core_->find(id);
  HistoryEdit edit;
  if (entry.enabled) edit.out = entry.stroke.get();
  std::unique_ptr<PreparedStroke> old;  // versions refer to it until they are replaced
  core_->apply(edit, progress, [&] {
    old = std::move(entry.stroke);
    core_->order.erase(core_->order.begin() + static_cast<std::ptrdiff_t>(old->rank));
    core_->ranks.erase(id);
  });
}

void History::move(StrokeId id, std::optional<StrokeId> before, const Progress& progress) {
  Core::Entry& entry = core_->find(id);
  const std::size_t from = entry.stroke->rank;
  const std::size_t to = before ? core_->find(*before).stroke->rank : core_->order.size();
  HistoryEdit edit;
  if (entry.enabled) edit = {entry.stroke.get(), entry.stroke.get(), to};
  core_->apply(edit, progress, [&] {
    const auto at = [&](std::size_t k) { return core_->order.begin() + static_cast<std::ptrdiff_t>(k); };
    if (to > from)
      std::rotate(at(from), at(from + 1), at(to));
    else
      std::rotate(at(to), at(from), at(from + 1));
  });
}

void History::enable(StrokeId id, bool enabled, const Progress& progress) {
  Core::Entry& entry = core_->find(id);
  HistoryEdit edit;
  if (enabled && !entry.enabled) edit.in = entry.stroke.get(), edit.at = entry.stroke->rank;
  if (!enabled && entry.enabled) edit.out = entry.stroke.get();
  core_->apply(edit, progress, [&] { entry.enabled = enabled; });
}

const Volume& History::volume() const {
  return core_->now;
}

const Volume& History::base() const {
  return core_->base;
}

std::vector<StrokeId> History::ids() const {
  std::vector<StrokeId> out;
  for (const Core::Entry& entry : core_->order) out.push_back(entry.stroke->id);
  return out;
}

const HistoryStroke& History::stroke(StrokeId id) const {
  return core_->find(id).stroke->stroke;
}

bool History::enabled(StrokeId id) const {
  return core_->find(id).enabled;
}

HistoryStats History::stats() const {
  HistoryStats out = core_->stats;
  out.strokes = core_->order.size();
  for (std::size_t g = 0; g < core_->versions.size(); ++g)
    for (std::size_t t = 0; t < core_->versions[g].size(); ++t) {
      const VersionCost cost = core_->cost(g, t);
      out.versions += cost.count, out.version_bytes += cost.bytes;
    }
  for (const Core::Entry& entry : core_->order) {
    out.stroke_bytes += entry.stroke->stroke.poses.capacity() * sizeof(Pose);
    out.stroke_bytes += entry.stroke->stroke.rolled.capacity() * sizeof(RolledPose);
    for (const TouchedTiles& touched : entry.stroke->touched) out.stroke_bytes += touched.nbytes();
  }
  return out;
}

}  // namespace riffler::sweep
