#include "plan/rough/level.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/math.hpp"
#include "plan/rough/clear_paths.hpp"
#include "plan/rough/passes.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr double kBorder = 0.25;                    // precision of borders, in tolerances
constexpr double kSmaller = 0.8, kLeastStep = 0.4;  // factor and lower limit of steps that would cut too wide
constexpr double kWideShare = 0.05;                 // largest share of a ring that may cut too wide
constexpr double kAcross = 0.1;                     // mm of path that take as long as 1 mm of a rapid
constexpr double kAround = 2;                       // spacings before and after a cut that is too wide: also leads
constexpr double kCrumb = 2;                        // spacings: a ring leaves shorter cuts to the next ring
constexpr double kLastRings = 0.7;                  // radii between the rings that search for remaining material
constexpr double kRoomyHelix = 0.3, kLeastHelix = 0.1, kLeastRamp = 0.25;  // shares of full helix and ramp

/// A short move, the width of its cut, and whether it begins a line.
struct Step {
  Vec2 to;
  double length, width;
  bool begins;
};

class Level {
 public:
  Level(const LevelScene& scene, double z, double least, double link)
      : scene_(scene),
        grid_(scene.grid),
        z_(z),
        link_(link),
        in_(grid_.size()),
        standing_(grid_.size()),
        material_(grid_.size()),
        reach_(scene.radius - kCellRadius * grid_.spacing),
        layer_(layer(least)),
        paths_(grid_, in_, standing_, layer_, scene.widest_radius),
        step_(scene.step) {}

  LevelRuns run() {
    const Field near = distance_to(grid_, material_);
    PlaceSet cleared(grid_.size()), wanted(grid_.size());
    bool any = false;
    for (std::size_t k = 0; k < in_.size(); ++k) {
      cleared[k] = in_[k] && near[k] > reach_, wanted[k] = in_[k] && near[k] <= reach_;
      any = any || wanted[k];
    }
    if (!any) return std::move(out_);
    lengths_ = path_lengths(grid_, in_, cleared);
    enter_all(wanted);
    sort_cells();
    double most = 0;
    for (std::size_t k = 0; k < lengths_.size(); ++k)
      if (wanted[k] && lengths_[k] < kInfinity) most = std::max(most, lengths_[k]);
    for (double at = 0; at < most; ++out_.rings) base::still_wanted(), at = cut_ring(at);
    cut(passes_on(borders(near), scene_.step, 0));
    const double last = kLastRings * scene_.radius;
    for (double at = std::min(scene_.step, 0.5 * most); at < most; at += last) cut(passes_on(ring(at), scene_.step, 0));
    measure_rises();
    return std::move(out_);
  }

 private:
  /// The cells with material that the cutter can remove from some place. Fills `in_`, `material_` and `standing_`.
  Layer layer(double least) {
    for (std::size_t k = 0; k < in_.size(); ++k) in_[k] = scene_.heights[k] <= z_;
    const Field far = distance_to(grid_, in_);
    PlaceSet whole(grid_.size()), touched(grid_.size());
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const bool there = scene_.stock.top(k) > z_ + least;
      whole[k] = there && far[k] <= reach_, touched[k] = there && far[k] <= scene_.radius;
      standing_[k] = scene_.stock.top(k) > z_ && !touched[k];
    }
    find_holes(least, far);
    material_ = without_slivers(grid_, whole, scene_.sliver);
    return {grid_, material_, touched, scene_.radius};
  }

  /// Finds areas with stock and without part of which the cutter reaches nothing. Areas of a cell or two are ignored.
  void find_holes(double least, const Field& far) {
    PlaceSet open(grid_.size());
    for (std::size_t k = 0; k < open.size(); ++k) open[k] = scene_.ground[k] <= z_ && scene_.stock.top(k) > z_ + least;
    const auto up = static_cast<std::size_t>(grid_.columns);
    std::vector<std::size_t> area;
    for (std::size_t first = 0; first < open.size(); ++first) {
      if (!open[first]) continue;
      area.assign(1, first), open[first] = 0;
      bool reached = false;
      std::size_t middle = open.size();
      for (std::size_t i = 0; i < area.size(); ++i) {
        const std::size_t k = area[i], column = k % up;
        reached = reached || far[k] <= scene_.radius;
        std::size_t around = 0;
        const auto look = [&](std::size_t next) {
          around += scene_.ground[next] <= z_;
          if (std::exchange(open[next], 0)) area.push_back(next);
        };
        if (column > 0) look(k - 1);
        if (column + 1 < up) look(k + 1);
        if (k >= up) look(k - up);
        if (k + up < open.size()) look(k + up);
        if (around == 4 && middle == open.size()) middle = k;
      }
      if (!reached && middle < open.size()) out_.holes.emplace_back(grid_.place(middle), z_);
    }
  }

  /// Makes an entry at the widest place of each area to which no path leads. Leaves out areas that are too narrow.
  void enter_all(PlaceSet& wanted) {
    std::vector<std::size_t> closed;
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (wanted[k] && lengths_[k] == kInfinity) closed.push_back(k);
    if (closed.empty()) return;
    PlaceSet out(grid_.size());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = !in_[k];
    const Field room = distance_to(grid_, out);
    std::stable_sort(closed.begin(), closed.end(), [&](std::size_t a, std::size_t b) { return room[a] > room[b]; });
    for (const std::size_t best : closed) {
      if (lengths_[best] < kInfinity || !wanted[best]) continue;
      if (const std::optional<Entry> entry = entry_at(best, room[best])) {
        enter(*entry, best);
      } else {
        out_.narrow.emplace_back(grid_.place(best), z_);
        leave_out(best, wanted);
      }
    }
  }

  std::optional<Entry> entry_at(std::size_t best, double room) const {
    const double radius = std::min(scene_.helix, room - grid_.spacing);
    const Entry helix{{grid_.place(best)}, radius};
    if (radius >= kRoomyHelix * scene_.helix) return helix;
    Entry ramp{ramp_from(grid_, in_, best, scene_.slot), 0};
    if (length_of(ramp.path) >= kLeastRamp * scene_.slot) return ramp;
    if (radius >= kLeastHelix * scene_.helix) return helix;
    return {};
  }

  void enter(const Entry& entry, std::size_t best) {
    LevelRun run;
    run.tips = level_way(entry, z_);
    run.kinds.assign(run.tips.size(), MoveKind::Lead);
    run.entry = entry;
    for (const Vec3& tip : run.tips) layer_.place(Vec2(tip));
    out_.runs.push_back(std::move(run)), ++out_.entries;
    std::vector<std::size_t> cleared{best};
    if (entry.radius == 0)
      for (const Vec2& p : entry.path) cleared.push_back(grid_.nearest(p));
    const int around = static_cast<int>(entry.radius / grid_.spacing);
    const auto columns = static_cast<std::size_t>(grid_.columns);
    const int column = static_cast<int>(best % columns), row = static_cast<int>(best / columns);
    for (int dy = -around; dy <= around; ++dy)
      for (int dx = -around; dx <= around; ++dx) {
        if (grid_.spacing * std::sqrt(static_cast<double>(dx * dx + dy * dy)) > entry.radius) continue;
        if (column + dx < 0 || row + dy < 0 || column + dx >= grid_.columns || row + dy >= grid_.rows) continue;
        cleared.push_back(grid_.index(column + dx, row + dy));
      }
    add_path_lengths(grid_, in_, cleared, lengths_);
  }

  /// Removes the whole area around a place from `wanted`.
  void leave_out(std::size_t place, PlaceSet& wanted) const {
    Field area(grid_.size(), kInfinity);
    add_path_lengths(grid_, in_, {place}, area);
    for (std::size_t k = 0; k < area.size(); ++k)
      if (area[k] < kInfinity) wanted[k] = 0;
  }

  /// Curves around the places to which paths lead, on the inner side of their border.
  std::vector<Curve> borders(const Field& near) const {
    Field side(grid_.size());
    for (std::size_t k = 0; k < side.size(); ++k) side[k] = in_[k] && lengths_[k] < kInfinity ? -1 : 1;
    return contours(grid_, side, 0, [&](std::size_t in, std::size_t out) {
      Vec2 a = grid_.place(in), b = grid_.place(out);
      if (near[in] > reach_ + 2 * grid_.spacing) return a;
      while (glm::length(b - a) > kBorder * scene_.tolerance) {
        const Vec2 middle = 0.5 * (a + b);
        (scene_.surface.stops_above(Vec3(middle, 0), z_) ? b : a) = middle;
      }
      return a;
    });
  }

  /// Sorts the cells that rings may cross by the smallest path length at their corners.
  void sort_cells() {
    const auto up = static_cast<std::size_t>(grid_.columns);
    for (int row = 0; row + 1 < grid_.rows; ++row)
      for (int column = 0; column + 1 < grid_.columns; ++column) {
        const std::size_t k = grid_.index(column, row);
        const auto [low, high] = std::minmax({lengths_[k], lengths_[k + 1], lengths_[k + up], lengths_[k + up + 1]});
        if (high > 0 && high < kInfinity) cells_.emplace_back(low, k);
      }
    std::sort(cells_.begin(), cells_.end());
  }

  /// Curves of one path length. Lengths of neighbouring places differ by at most the spacing.
  std::vector<Curve> ring(double length) const {
    const auto at = [&](double x) {
      return std::lower_bound(cells_.begin(), cells_.end(), std::pair<double, std::size_t>(x, 0));
    };
    std::vector<std::size_t> cells;
    const auto last = at(length);
    for (auto cell = at(length - 2.01 * grid_.spacing); cell != last; ++cell) cells.push_back(cell->second);
    return contours(grid_, lengths_, length, {}, cells);
  }

  /// Cuts the ring beyond path length `at`, and returns the ring's path length. Where the front is concave, a full step
  /// would cut too wide: then this ring takes a smaller step, and the next ring a step that is hardly larger.
  double cut_ring(double at) {
    const Layer before = layer_;
    const std::size_t runs = out_.runs.size();
    const double widest = out_.widest, since = since_wide_;
    for (step_ = std::min(scene_.step, step_ / kSmaller);; step_ *= kSmaller) {
      const double wide = wide_, all = all_;
      cut(passes_on(ring(at + step_), step_, kCrumb * grid_.spacing));
      if (wide_ - wide <= kWideShare * (all_ - all) || step_ * kSmaller < kLeastStep * scene_.step) return at + step_;
      out_.runs.resize(runs), out_.widest = widest, since_wide_ = since;
      layer_ = before, wide_ = wide, all_ = all;
      paths_.forget();
    }
  }

  PassScene pass_scene(double step, double least) const {
    return {grid_, in_, scene_.climb ? 1.0 : -1.0, step, scene_.ramp, scene_.radius, least};
  }

  std::vector<Pass> passes_on(const std::vector<Curve>& curves, double step, double least) {
    pass_step_ = step;
    std::vector<Pass> passes;
    for (Curve curve : curves) {
      if (!scene_.climb) std::reverse(curve.points.begin(), curve.points.end());
      passes_along(curve, layer_, pass_scene(step, least), passes);
    }
    return passes;
  }

  /// Cuts the passes; the nearest pass is always next.
  void cut(const std::vector<Pass>& passes) {
    std::vector<char> done(passes.size(), 0);
    for (std::size_t left = passes.size(); left > 0; --left) {
      std::size_t best = passes.size(), start = 0;
      double least = kInfinity;
      for (std::size_t k = 0; k < passes.size(); ++k) {
        if (done[k]) continue;
        for (std::size_t i = 0; i < (passes[k].round ? passes[k].path.size() : 1); ++i)
          if (const double d = squared(passes[k].path[i]); d < least) least = d, best = k, start = i;
      }
      done[best] = 1;
      const Pass& pass = passes[best];
      cut_along(pass.round ? round_from(pass, start, pass_scene(pass_step_, 0)) : pass.path);
    }
  }
  double squared(const Vec2& p) const {
    if (out_.runs.empty()) return 0;
    const Vec2 off = p - Vec2(out_.runs.back().tips.back());
    return glm::dot(off, off);
  }

  void cut_along(const std::vector<Vec2>& path) {
    std::size_t first = 0;  // the path up to here removes nothing
    while (first + 1 < path.size() && layer_.spares(path[first + 1], kSpared)) ++first;
    if (first > 0) --first;
    const std::vector<Vec2> rest(path.begin() + static_cast<std::ptrdiff_t>(first), path.end());
    const std::vector<Vec2> points = simplified({rest, false}, scene_.tolerance).points;
    if (points.size() < 2) return;
    LevelRun run;
    std::vector<Vec2> way;
    const Vec2 last = out_.runs.empty() ? points[0] : Vec2(out_.runs.back().tips.back());
    if (!out_.runs.empty()) way = paths_.between(last, points[0], link_ + kAcross * glm::length(points[0] - last));
    run.linked = !way.empty();
    if (!run.linked) way = paths_.from_above(points[0], scene_.radius);
    if (way.empty()) way = {points[0]};
    for (const Vec2& p : way) run.tips.emplace_back(p, z_), run.kinds.push_back(MoveKind::Link);
    layer_.place(points[0]);
    steps_.clear();
    for (std::size_t k = 1; k < points.size(); ++k) move(points[k - 1], points[k]);
    add_steps(run);
    out_.runs.push_back(std::move(run));
  }

  /// Moves the cutter along a line in short steps.
  void move(const Vec2& from, const Vec2& to) {
    const int steps = 1 + static_cast<int>(glm::length(to - from) / (0.5 * grid_.spacing));
    for (int k = 1; k <= steps; ++k) {
      const Vec2 before = glm::mix(from, to, static_cast<double>(k - 1) / steps),
                 here = k == steps ? to : glm::mix(from, to, static_cast<double>(k) / steps);
      steps_.push_back({here, glm::length(here - before), layer_.move(before, here), k == 1});
    }
  }

  /// Appends the steps to a run. Steps near a place where the cut is too wide become leads, because cells lose their
  /// middles a little before and after that place.
  void add_steps(LevelRun& run) {
    std::vector<char> wide(steps_.size(), 0);
    const auto spread = [&](std::size_t k, double& since) {
      since = steps_[k].width > scene_.widest * (1 + 1e-9) ? 0 : since + steps_[k].length;
      if (since < kAround * grid_.spacing) wide[k] = 1;
    };
    for (std::size_t k = 0; k < steps_.size(); ++k) spread(k, since_wide_);
    double ahead = kInfinity;
    for (std::size_t k = steps_.size(); k-- > 0;) spread(k, ahead);
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const Step& step = steps_[k];
      all_ += step.length, wide_ += wide[k] ? step.length : 0;
      if (!wide[k]) out_.widest = std::max(out_.widest, step.width);
      const MoveKind kind = wide[k] ? MoveKind::Lead : MoveKind::Cut;
      if (!step.begins && kind == run.kinds.back())
        run.tips.back() = Vec3(step.to, z_);
      else
        run.tips.emplace_back(step.to, z_), run.kinds.push_back(kind);
    }
  }

  void measure_rises() {
    for (LevelRun& run : out_.runs) {
      base::still_wanted();
      run.rises.assign(run.tips.size(), 0);
      for (std::size_t k = 1; k < run.tips.size(); ++k)
        run.rises[k] = scene_.floor.rise(run.tips[k - 1], run.tips[k], 0).above;
    }
  }

  const LevelScene& scene_;
  const PlaceGrid& grid_;
  double z_, link_;
  PlaceSet in_, standing_, material_;
  double reach_;
  LevelRuns out_;
  Layer layer_;
  ClearPaths paths_;
  std::vector<Step> steps_;  // steps of the present pass
  double step_, pass_step_ = 0;
  Field lengths_;
  std::vector<std::pair<double, std::size_t>> cells_;
  double since_wide_ = kInfinity;  // mm since the last move that cut too wide
  double wide_ = 0, all_ = 0;      // mm: length of the moves that cut too wide, and of all moves
};

}  // namespace

LevelRuns level_runs(const LevelScene& scene, double z, double least, double link) {
  return Level(scene, z, least, link).run();
}

}  // namespace riffler::plan
