#include "sweep/carve.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "geom/parallel.hpp"
#include "sweep/steps.hpp"
#include "sweep/tile_cut.hpp"

namespace riffler {

namespace {

/// Steps that are cut in one go: enough to fill all threads, few enough to stay in the cache.
constexpr std::size_t kBatch = 2048;
/// Rays below which starting threads costs more than it gains.
constexpr double kSerialRays = 2e4;

std::string row(std::size_t i) {
  return "poses, row " + std::to_string(i) + ": ";
}

std::vector<Pose> checked(std::span<const Pose> poses) {
  std::vector<Pose> out(poses.begin(), poses.end());
  for (std::size_t i = 0; i < out.size(); ++i) {
    Pose& p = out[i];
    if (!finite(p.tip) || !finite(p.axis)) throw std::invalid_argument(row(i) + "not finite");
    const double length = glm::length(p.axis);
    if (!(std::abs(length - 1) < 1e-6))
      throw std::invalid_argument(row(i) + "the axis must be a unit vector; its length is " + std::to_string(length));
    p.axis /= length;
    if (i > 0 && glm::dot(out[i - 1].axis, p.axis) < 0 && glm::length(glm::cross(out[i - 1].axis, p.axis)) < 1e-14)
      throw std::invalid_argument(row(i) + "the axis is exactly opposite to that of the row before, so the way it " +
                                  "turns is undefined; put a pose between");
  }
  return out;
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

/// What one tile contributes to one move.
struct Share {
  std::uint32_t move;
  double removed = 0;
  Vec3 force{0}, torque{0};
};

/// Cuts one grid, batch by batch.
class GridCarver {
 public:
  GridCarver(Grid& grid, bool measured, const std::vector<Pose>& poses, const CarveOptions& options, Cut& cut,
             Rollback& rollback)
      : grid_(grid), measured_(measured), options_(options), cut_(cut), rollback_(rollback), poses_(poses) {
    for (Pose& p : poses_) p = {to_local(grid.axis(), p.tip), to_local(grid.axis(), p.axis)};
    for (std::size_t m = 0; m + 1 < poses_.size(); ++m) motions_.emplace_back(poses_[m], poses_[m + 1]);
  }

  void run(const Tool& tool, const std::function<void(std::size_t)>& moves_done) {
    for (std::size_t m = 0; m < motions_.size(); ++m) {
      for (const Piece& piece : tool.cutter())
        for_each_step(piece, motions_[m], static_cast<std::uint32_t>(m), grid_.box(), options_.tolerance,
                      [&](Step&& step) {
                        steps_.push_back(std::move(step));
                        if (steps_.size() == kBatch) flush(), moves_done(m);
                      });
    }
    flush();
  }

  const Stats& stats() const { return stats_; }

 private:
  struct Work {  // one tile and its steps in the batch
    std::size_t tile, begin, end;
    std::vector<Share> shares;
    Stats stats;
    std::shared_ptr<Tile> result;
  };

  void flush() {
    if (steps_.empty()) return;
    std::vector<Work> work = assign();
    double rays = 0;
    for (const Step& s : steps_) rays += s.footprint().rows().length() * s.footprint().columns().length();
    rays /= grid_.pitch() * grid_.pitch();
    const auto body = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) cut_tile(work[k]);
    };
    if (rays < kSerialRays)
      body(0, work.size());
    else
      parallel_for(work.size(), 1, body);
    for (Work& w : work) collect(w);
    stats_.steps += steps_.size();
    steps_.clear();
  }

  /// Tiles of the batch with the steps that may touch them, both in ascending order.
  std::vector<Work> assign() {
    pairs_.clear();
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Footprint& footprint = steps_[k].footprint();
      const auto [u0, u1] = indices(footprint.rows(), grid_.box().lower.x, grid_.nu());
      const auto [v0, v1] = indices(footprint.columns(), grid_.box().lower.y, grid_.nv());
      if (u0 > u1 || v0 > v1) continue;
      for (int a = u0 / kTileSide; a <= u1 / kTileSide; ++a)
        for (int b = v0 / kTileSide; b <= v1 / kTileSide; ++b) pairs_.emplace_back(grid_.tile_index(a, b), k);
    }
    std::sort(pairs_.begin(), pairs_.end());
    std::vector<Work> work;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (work.empty() || work.back().tile != pairs_[k].first) work.push_back({pairs_[k].first, k, k, {}, {}, {}});
      work.back().end = k + 1;
    }
    return work;
  }

  /// First and last ray whose coordinate lies in `range`.
  std::pair<int, int> indices(const Interval& range, double lower, int n) const {
    if (range.empty()) return {0, -1};
    const double h = grid_.pitch();
    const double first = std::ceil((range.near - lower) / h - 0.5), last = std::floor((range.far - lower) / h - 0.5);
    return {static_cast<int>(std::clamp(first, 0.0, static_cast<double>(n))),
            static_cast<int>(std::clamp(last, -1.0, n - 1.0))};
  }

  void cut_tile(Work& work) const {
    const Tile& tile = grid_.tile(work.tile);
    TileCut cut(tile, grid_.has_normals(), 1e-9 * grid_.pitch());
    std::uint32_t last_move = ~0U;
    for (std::size_t k = work.begin; k < work.end; ++k) {
      const Step& step = steps_[pairs_[k].second];
      if (tile.reach.cut(step.footprint().height()).empty()) continue;  // the tool stays above or below the tile
      work.stats.tiles_visited += step.move() != last_move;
      last_move = step.move();
      cut_step(work, cut, step);
    }
    if (!cut.changed()) return;
    work.result = cut.finish();
    work.stats.tiles_changed = 1;
    work.stats.bytes_copied = work.result->nbytes();
  }

  void cut_step(Work& work, TileCut& cut, const Step& step) const {
    const int tile_u = static_cast<int>(work.tile) / grid_.tiles_v(),
              tile_v = static_cast<int>(work.tile) % grid_.tiles_v();
    const auto [u0, u1] = indices(step.footprint().rows(), grid_.box().lower.x, grid_.nu());
    const int first_u = std::max(u0, tile_u * kTileSide), last_u = std::min(u1, tile_u * kTileSide + kTileSide - 1);
    for (int i = first_u; i <= last_u; ++i) {
      const double u = grid_.shifted_u(i);
      const auto [v0, v1] = indices(step.footprint().row(u), grid_.box().lower.y, grid_.nv());
      const int first_v = std::max(v0, tile_v * kTileSide), last_v = std::min(v1, tile_v * kTileSide + kTileSide - 1);
      for (int j = first_v; j <= last_v; ++j) cut_ray(work, cut, step, i, j, u, grid_.shifted_v(j));
    }
  }

  void cut_ray(Work& work, TileCut& cut, const Step& step, int i, int j, double u, double v) const {
    const int r = Grid::ray_index(i, j);
    const std::span<const Span> spans = cut.ray(r);
    if (spans.empty() || spans.front().near >= step.footprint().height().far ||
        spans.back().far <= step.footprint().height().near)
      return;
    ++work.stats.rays_tested;
    SweptIntervals swept;
    step.hit(u, v, {spans.front().near, spans.back().far}, swept);
    bool changed = false;
    for (const SweptInterval& interval : swept) changed |= cut_interval(work, cut, step, r, u, v, interval);
    work.stats.rays_changed += changed;
  }

  bool cut_interval(Work& work, TileCut& cut, const Step& step, int r, double u, double v,
                    const SweptInterval& interval) const {
    const auto normals = [&](PackedNormal& at_near, PackedNormal& at_far) {
      // The material's new surface looks into the tool.
      at_near = PackedNormal::pack(to_world(grid_.axis(), -step.normal(u, v, interval.near, interval.near_t)));
      at_far = PackedNormal::pack(to_world(grid_.axis(), -step.normal(u, v, interval.far, interval.far_t)));
    };
    const auto removed = [&](double lo, double hi) {
      if (measured_) add_share(work, step, (interval.near_t + interval.far_t) / 2, {u, v, (lo + hi) / 2}, hi - lo);
    };
    return cut.subtract(r, {interval.near.s, interval.far.s}, normals, removed);
  }

  /// (3.18)–(3.24) with k per volume and second; the direction is against the velocity of the tool's material point at
  /// the piece, which contains the source's cases I–IV, and along the axis where that point stands still.
  void add_share(Work& work, const Step& step, double t, const Vec3& p, double length) const {
    if (work.shares.empty() || work.shares.back().move != step.move())
      work.shares.push_back({step.move(), 0, Vec3(0), Vec3(0)});
    Share& share = work.shares.back();
    const double removed = length * grid_.pitch() * grid_.pitch();
    share.removed += removed;
    if (options_.dt.empty()) return;
    const Motion& motion = motions_[step.move()];
    const Vec3 velocity = motion.velocity(p, t);
    const double speed = glm::length(velocity);
    const Vec3 direction = speed > 0 ? -velocity / speed : motion.axis(t);
    const Vec3 force = direction * (options_.removal_constant * removed / options_.dt[step.move()]);
    share.force += force;
    share.torque += glm::cross(p - motion.to().tip, force);
  }

  void collect(Work& w) {
    stats_ += w.stats;
    for (const Share& s : w.shares) {
      cut_.removed[s.move] += s.removed;
      cut_.force[s.move] += to_world(grid_.axis(), s.force);
      cut_.torque[s.move] += to_world(grid_.axis(), s.torque);
    }
    if (!w.result) return;
    rollback_.keep(grid_, w.tile);
    grid_.set_tile(w.tile, std::move(w.result));
  }

  Grid& grid_;
  bool measured_;
  const CarveOptions& options_;
  Cut& cut_;
  Rollback& rollback_;
  std::vector<Pose> poses_;  // in the grid's cyclic frame
  std::vector<Motion> motions_;
  std::vector<Step> steps_;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;  // (tile, step)
  Stats stats_;
};

}  // namespace

Cut carve(Volume& volume, const Tool& tool, std::span<const Pose> poses, const CarveOptions& options) {
  const std::size_t moves = poses.empty() ? 0 : poses.size() - 1;
  const std::vector<Pose> path = checked(poses);
  check(options, moves);
  Cut cut{std::vector<double>(moves), std::vector<Vec3>(moves, Vec3(0)), std::vector<Vec3>(moves, Vec3(0))};
  Rollback rollback;
  Stats stats;
  stats.moves = moves;
  const std::size_t grids = volume.grids().size();
  for (std::size_t g = 0; g < grids; ++g) {
    Grid& grid = volume.grids()[g];
    GridCarver carver(grid, &grid == &volume.reference(), path, options, cut, rollback);
    carver.run(tool, [&](std::size_t done) {
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

}  // namespace riffler
