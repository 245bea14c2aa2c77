#include "sweep/carve.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>

#include "geom/parallel.hpp"
#include "sweep/steps.hpp"
#include "sweep/tile_cutter.hpp"

namespace riffler {

namespace {

/// Steps that are cut in one go: enough to fill all threads, few enough to stay in the cache.
constexpr std::size_t kBatch = 512;
/// Rays below which starting threads costs more than it gains.
constexpr double kSerialRays = 1e5;

std::string row(std::size_t i) {
  return "poses, row " + std::to_string(i) + ": ";
}

void check(const CarveOptions& options, std::size_t moves) {
  if (!std::isfinite(options.tolerance) || !(options.tolerance > 0))
    throw std::invalid_argument("tolerance must be a positive length in mm");
  if (!std::isfinite(options.removal_constant) || options.removal_constant < 0)
    throw std::invalid_argument("removal_constant must not be negative");
  if (!options.dt.empty() && options.dt.size() != moves)
    throw std::invalid_argument("dt must have one value per move: " + std::to_string(moves) + ", not " +
                                std::to_string(options.dt.size()));
  for (std::size_t i = 0; i < options.dt.size(); ++i)
    if (!std::isfinite(options.dt[i]) || !(options.dt[i] > 0))
      throw std::invalid_argument("dt, row " + std::to_string(i) + ": must be a positive time in s");
}

/// What a call gives back, one entry per move; asked of the system only where it may matter.
void check_memory(std::size_t moves) {
  const double bytes = static_cast<double>(moves) * (sizeof(double) + 2 * sizeof(Vec3));
  if (moves < 1'000'000 || bytes <= available_memory()) return;
  throw std::invalid_argument("poses: the results of " + std::to_string(moves) + " moves need " +
                              std::to_string(static_cast<long long>(bytes / 1e6)) +
                              " MB, more than this machine has free; carve them in several calls");
}

/// Brings back the tiles that were replaced unless the carve ends well. Costs what was cut, not what there is.
class Rollback {
 public:
  Rollback() = default;
  Rollback(const Rollback&) = delete;
  Rollback& operator=(const Rollback&) = delete;
  ~Rollback() {
    if (armed_)
      for (auto& [place, tile] : first_) place.first->set_tile(place.second, std::move(tile));
  }
  void keep(Grid& grid, std::size_t tile) { first_.try_emplace({&grid, tile}, grid.shared_tile(tile)); }
  /// The carve ended well. Returns whether anything was replaced.
  bool commit() { return armed_ = false, !first_.empty(); }

 private:
  std::map<std::pair<Grid*, std::size_t>, std::shared_ptr<const Tile>> first_;
  bool armed_ = true;
};

/// Cuts one grid, batch by batch.
class GridCarver {
 public:
  /// `rollback` may be null.
  GridCarver(Grid& grid, bool measured, const CarveOptions& options, Cut& cut, Rollback* rollback)
      : grid_(grid), measured_(measured), options_(options), cut_(cut), rollback_(rollback) {}

  /// Move m of `moves` goes to poses[end(m)] from the pose before it. Holds no more of the program than one batch, so
  /// its length costs no memory here.
  template <class End, class Done>
  void run(std::span<const ConvexGroup> cutter, std::span<const Pose> poses, std::size_t moves, const End& end,
           const Done& moves_done) {
    Pose from;
    std::size_t last = 0;
    for (std::size_t m = 0; m < moves; ++m) {
      const std::size_t e = end(m);
      if (m == 0 || last != e - 1) from = local(poses[e - 1]);
      last = e;
      const Pose to = local(poses[e]);
      const Motion& motion = motions_.emplace_back(from, to);
      for_each_step(cutter, motion, static_cast<std::uint32_t>(m), grid_.box(), options_.tolerance,
                    [&](Step&& step) { steps_.push_back(std::move(step)); });
      if (steps_.size() >= kBatch || motions_.size() >= kBatch) flush(), moves_done(m);
      from = to;
    }
    flush();
  }

  const Stats& stats() const { return stats_; }

 private:
  struct Work {  // one tile and its steps in the batch
    std::size_t tile, begin, end;
    TileResult done;
  };

  Pose local(const Pose& p) const {
    return {to_local(grid_.axis(), p.tip), glm::normalize(to_local(grid_.axis(), p.axis))};
  }

  void flush() {
    if (!steps_.empty()) cut_steps();
    stats_.steps += steps_.size();
    steps_.clear(), motions_.clear();
  }

  void cut_steps() {
    std::vector<Work> work = assign();
    double rays = 0;
    for (const Step& s : steps_) rays += s.footprint.rows().length() * s.footprint.columns().length();
    rays /= grid_.pitch() * grid_.pitch();
    const auto body = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) cut_tile(work[k]);
    };
    if (rays < kSerialRays)
      body(0, work.size());
    else
      parallel_for(work.size(), 1, body);
    for (Work& w : work) collect(w);
  }

  /// Tiles of the batch with the steps that may touch them, both in ascending order.
  std::vector<Work> assign() {
    pairs_.clear();
    std::size_t first = std::numeric_limits<std::size_t>::max(), last = 0;
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Footprint& footprint = steps_[k].footprint;
      const auto [u0, u1] = ray_indices(footprint.rows(), grid_.box().lower.x, grid_.pitch(), grid_.nu());
      const auto [v0, v1] = ray_indices(footprint.columns(), grid_.box().lower.y, grid_.pitch(), grid_.nv());
      if (u0 > u1 || v0 > v1) continue;
      for (int a = u0 / kTileSide; a <= u1 / kTileSide; ++a)
        for (int b = v0 / kTileSide; b <= v1 / kTileSide; ++b) pairs_.emplace_back(grid_.tile_index(a, b), k);
      first = std::min(first, grid_.tile_index(u0 / kTileSide, v0 / kTileSide));
      last = std::max(last, grid_.tile_index(u1 / kTileSide, v1 / kTileSide));
    }
    sort_pairs(first, last);
    std::vector<Work> work;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (work.empty() || work.back().tile != pairs_[k].first) work.push_back({pairs_[k].first, k, k, {}});
      work.back().end = k + 1;
    }
    return work;
  }

  /// By tiles, all of them from `first` to `last`; steps ascend already. They are counted where they are many for that
  /// range: short moves pass the same few tiles again and again.
  void sort_pairs(std::size_t first, std::size_t last) {
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
  void cut_tile(Work& work) const {
    const Tile& tile = grid_.tile(work.tile);
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

  void collect(Work& w) {
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

  Grid& grid_;
  bool measured_;
  const CarveOptions& options_;
  Cut& cut_;
  Rollback* rollback_;
  std::deque<Motion> motions_;  // of the batch, in the grid's cyclic frame; steps point to them
  std::vector<Step> steps_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_, sorted_;  // (tile, step)
  std::vector<std::uint32_t> starts_;
  Stats stats_;
};

}  // namespace

void check_path(std::span<const Pose> poses) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Pose& p = poses[i];
    if (!finite(p.tip) || !finite(p.axis)) throw std::invalid_argument(row(i) + "not finite");
    const double length = glm::length(p.axis);
    if (!(std::abs(length - 1) < 1e-6))
      throw std::invalid_argument(row(i) + "the axis must be a unit vector; its length is " + std::to_string(length));
    if (i == 0) continue;
    const Vec3 axis = p.axis / length, before = glm::normalize(poses[i - 1].axis);
    if (glm::dot(before, axis) < 0 && glm::length(glm::cross(before, axis)) < 1e-14)
      throw std::invalid_argument(row(i) + "the axis is exactly opposite to that of the row before, so the way it " +
                                  "turns is undefined; put a pose between");
  }
}

Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options) {
  const std::size_t moves = poses.empty() ? 0 : poses.size() - 1;
  check_path(poses);
  check(options, moves);
  check_memory(moves);
  Cut cut{std::vector<double>(moves), std::vector<Vec3>(moves, Vec3(0)), std::vector<Vec3>(moves, Vec3(0))};
  const std::vector<ConvexGroup> cutter = convex_groups(tool.cutter());
  Rollback rollback;
  Stats stats;
  stats.moves = moves;
  const std::size_t grids = volume.grids().size();
  for (std::size_t g = 0; g < grids; ++g) {
    Grid& grid = volume.grids()[g];
    GridCarver carver(grid, &grid == &volume.reference(), options, cut, &rollback);
    const auto next = [](std::size_t m) { return m + 1; };
    carver.run(cutter, poses, moves, next, [&](std::size_t done) {
      report(options.progress, (static_cast<double>(g) + static_cast<double>(done) / static_cast<double>(moves)) /
                                   static_cast<double>(grids));
    });
    report(options.progress, static_cast<double>(g + 1) / static_cast<double>(grids));
    stats += carver.stats();
  }
  if (rollback.commit()) volume.touch();
  volume.count(stats);
  return cut;
}

std::vector<double> carve_moves(Grid& grid, std::span<const ConvexGroup> cutter, std::span<const Pose> poses,
                                std::span<const std::uint32_t> ends, double tolerance, Stats& stats) {
  CarveOptions options;
  options.tolerance = tolerance;
  Cut cut{std::vector<double>(ends.size()), std::vector<Vec3>(ends.size()), std::vector<Vec3>(ends.size())};
  GridCarver carver(grid, true, options, cut, nullptr);
  carver.run(cutter, poses, ends.size(), [&](std::size_t m) { return ends[m]; }, [](std::size_t) {});
  stats += carver.stats();
  stats.moves += ends.size();
  return std::move(cut.removed);
}

}  // namespace riffler
