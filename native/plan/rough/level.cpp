#include "plan/rough/level.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geom/math.hpp"
#include "plan/rough/passes.hpp"

namespace riffler::plan {

namespace {

constexpr int kBisections = 12;
constexpr double kHelixStep = kPi / 18;
constexpr double kSmaller = 0.8, kLeastStep = 0.4;  // steps of a ring that would cut too wide
constexpr double kWideShare = 0.03;                 // of a ring that may

class Level {
 public:
  Level(const LevelScene& scene, double z, double least, StockTops& tops)
      : scene_(scene),
        grid_(scene.grid),
        z_(z),
        tops_(tops),
        in_(grid_.size()),
        reach_(scene.radius - kCellRadius * grid_.spacing),
        layer_(layer(least)) {}

  LevelRuns run() {
    const Field near = distance_to(grid_, layer_.material());
    PlaceSet cleared(grid_.size()), wanted(grid_.size());
    bool any = false;
    for (std::size_t k = 0; k < in_.size(); ++k) {
      cleared[k] = in_[k] && near[k] > reach_, wanted[k] = in_[k] && near[k] <= reach_;
      any = any || wanted[k];
    }
    if (!any) return {};
    Field lengths = path_lengths(grid_, in_, cleared);
    while (enter(lengths, wanted, cleared)) lengths = path_lengths(grid_, in_, cleared);
    double most = 0;
    for (std::size_t k = 0; k < lengths.size(); ++k)
      if (wanted[k]) most = std::max(most, lengths[k]);
    for (double at = 0; at < most; ++out_.rings) at = cut_ring(lengths, at);
    cut(passes_on(borders(near), scene_.step));
    return std::move(out_);
  }

 private:
  /// The cells with material that the cutter removes from some place; fills `in_`.
  Layer layer(double least) {
    for (std::size_t k = 0; k < in_.size(); ++k) in_[k] = scene_.heights[k] <= z_;
    const Field far = distance_to(grid_, in_);
    PlaceSet whole(grid_.size()), touched(grid_.size());
    for (std::size_t k = 0; k < whole.size(); ++k) {
      const bool there = tops_.top(k) > z_ + least;
      whole[k] = there && far[k] <= reach_, touched[k] = there && far[k] <= scene_.radius;
    }
    return {grid_, without_slivers(grid_, whole, scene_.sliver), std::move(touched), scene_.radius};
  }

  /// Enters the widest place of an area that no path leads to, by a helix, or straight down where it is too narrow.
  bool enter(const Field& lengths, const PlaceSet& wanted, PlaceSet& cleared) {
    PlaceSet out(grid_.size());
    bool any = false;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = !in_[k], any = any || (wanted[k] && lengths[k] == kInfinity);
    if (!any) return false;
    const Field room = distance_to(grid_, out);
    std::size_t best = grid_.size();
    for (std::size_t k = 0; k < out.size(); ++k)
      if (wanted[k] && lengths[k] == kInfinity && (best == grid_.size() || room[k] > room[best])) best = k;
    const Vec2 middle = grid_.place(best);
    double radius = std::min(scene_.helix, room[best] - grid_.spacing);
    if (!(radius > 0.1 * scene_.helix)) {
      radius = 0;
      if (++out_.plunges == 1) out_.plunge = Vec3(middle, z_);
    }
    helix(middle, radius);
    for (std::size_t k = 0; k < cleared.size(); ++k)
      if (in_[k] && glm::length(grid_.place(k) - middle) <= radius) cleared[k] = 1;
    cleared[best] = 1;
    return true;
  }

  void helix(const Vec2& middle, double radius) {
    LevelRun run;
    const auto to = [&](const Vec2& p, double z) {
      run.tips.emplace_back(p, z), run.kinds.push_back(MoveKind::Lead);
      layer_.place(p), tops_.cut({p, z});
    };
    const double top = std::max(z_, std::max(tops_.highest(middle), tops_.highest(middle + Vec2(radius, 0))));
    run.top = top;
    const double down = std::max(1e-3, radius * kHelixStep * std::tan(scene_.slope));
    const int steps = radius > 0 ? static_cast<int>(std::ceil((top - z_) / down)) : 1;
    const int round = radius > 0 ? static_cast<int>(std::round(2 * kPi / kHelixStep)) : 0;
    for (int k = 0; k <= steps + round; ++k) {
      const double angle = k * kHelixStep;
      to(middle + radius * Vec2(std::cos(angle), std::sin(angle)), std::max(z_, top - (top - z_) * k / steps));
    }
    if (radius > 0) to(middle, z_);
    ++out_.helices;
    out_.runs.push_back(std::move(run));
  }

  /// Curves around the places that are in reach, on their side.
  std::vector<Curve> borders(const Field& near) const {
    Field side(grid_.size());
    for (std::size_t k = 0; k < side.size(); ++k) side[k] = in_[k] ? -1 : 1;
    return contours(grid_, side, 0, [&](std::size_t in, std::size_t out) {
      Vec2 a = grid_.place(in), b = grid_.place(out);
      if (near[in] > reach_ + 2 * grid_.spacing) return a;
      for (int k = 0; k < kBisections; ++k) {
        const Vec2 middle = 0.5 * (a + b);
        const DropCutter::Landing found = scene_.surface(Vec3(middle, 0));
        (found.touches && found.height > z_ ? b : a) = middle;
      }
      return a;
    });
  }

  /// Cuts a ring beyond the places as far as `at`, and returns how far it goes. Where the front is bent inwards, a full
  /// step would cut wider than asked for: then the ring takes a smaller one.
  double cut_ring(const Field& lengths, double at) {
    const LevelRuns runs = out_;
    const Layer layer = layer_;
    const StockTops tops = tops_;
    for (double step = scene_.step;; step *= kSmaller) {
      const double wide = wide_, all = all_;
      cut(passes_on(contours(grid_, lengths, at + step), step));
      if (wide_ - wide <= kWideShare * (all_ - all) || step * kSmaller < kLeastStep * scene_.step) return at + step;
      out_ = runs, layer_ = layer, tops_ = tops, wide_ = wide, all_ = all;
    }
  }

  std::vector<Pass> passes_on(const std::vector<Curve>& curves, double step) const {
    std::vector<Pass> passes;
    for (Curve curve : curves) {
      if (!scene_.climb) std::reverse(curve.points.begin(), curve.points.end());
      passes_along(curve, layer_, {grid_, in_, scene_.climb ? 1.0 : -1.0, step, scene_.ramp, scene_.radius}, passes);
    }
    return passes;
  }

  /// The nearest pass next.
  void cut(const std::vector<Pass>& passes) {
    std::vector<char> done(passes.size(), 0);
    for (std::size_t left = passes.size(); left > 0; --left) {
      std::size_t best = passes.size();
      for (std::size_t k = 0; k < passes.size(); ++k) {
        if (done[k] || (passes[k].after >= 0 && !done[static_cast<std::size_t>(passes[k].after)])) continue;
        if (best == passes.size() || squared(passes[k]) < squared(passes[best])) best = k;
      }
      done[best] = 1;
      cut(passes[best]);
    }
  }
  double squared(const Pass& pass) const {
    if (out_.runs.empty()) return 0;
    const Vec2 off = pass.path.front() - Vec2(out_.runs.back().tips.back());
    return glm::dot(off, off);
  }

  void cut(const Pass& pass) {
    const std::vector<Vec2> points = simplified({pass.path, false}, scene_.tolerance).points;
    if (points.size() < 2) return;
    LevelRun run{{Vec3(points[0], z_)}, {MoveKind::Lead}, tops_.highest(points[0])};
    run.linked = !out_.runs.empty() && clear(Vec2(out_.runs.back().tips.back()), points[0]);
    layer_.place(points[0]);
    for (std::size_t k = 1; k < points.size(); ++k) move(points[k - 1], points[k], run);
    out_.runs.push_back(std::move(run));
  }

  /// Moves the cutter along a line, which is divided where the width of cut goes beyond what is asked for, and back.
  void move(const Vec2& from, const Vec2& to, LevelRun& run) {
    const int steps = 1 + static_cast<int>(glm::length(to - from) / (0.5 * grid_.spacing));
    for (int k = 1; k <= steps; ++k) {
      const Vec2 before = glm::mix(from, to, static_cast<double>(k - 1) / steps),
                 here = k == steps ? to : glm::mix(from, to, static_cast<double>(k) / steps);
      const double width = layer_.move(before, here);
      // In what follows at once, some cells have just lost their middles.
      since_wide_ = width > scene_.widest * (1 + 1e-9) ? 0 : since_wide_ + glm::length(here - before);
      const bool wide = since_wide_ < 2 * grid_.spacing;
      all_ += glm::length(here - before), wide_ += wide ? glm::length(here - before) : 0;
      if (!wide) out_.widest = std::max(out_.widest, width);
      if (k % 2 == 0 || k == steps) tops_.cut({here, z_});
      const MoveKind kind = wide ? MoveKind::Lead : MoveKind::Cut;
      if (k > 1 && kind == run.kinds.back())
        run.tips.back() = Vec3(here, z_);
      else
        run.tips.emplace_back(here, z_), run.kinds.push_back(kind);
    }
  }

  /// Whether the cutter goes straight from one place to the other without cutting.
  bool clear(const Vec2& from, const Vec2& to) const {
    const double length = glm::length(to - from);
    const int steps = 1 + static_cast<int>(length / grid_.spacing);
    for (int k = 0; k <= steps; ++k) {
      const Vec2 p = glm::mix(from, to, static_cast<double>(k) / steps);
      // A pass ends at the border of what it clears.
      const bool leaves = k * length < 3 * grid_.spacing * steps;
      if (!in_[grid_.nearest(p)] || (leaves ? layer_.touches(p) : !layer_.frees(p))) return false;
    }
    return true;
  }

  const LevelScene& scene_;
  const PlaceGrid& grid_;
  double z_;
  StockTops& tops_;
  PlaceSet in_;
  double reach_;
  Layer layer_;
  LevelRuns out_;
  double since_wide_ = kInfinity;  // mm since the last move that cut wider than asked for
  double wide_ = 0, all_ = 0;      // mm: length of moves that cut wider than asked for, and of all
};

}  // namespace

LevelRuns level_runs(const LevelScene& scene, double z, double least, StockTops& tops) {
  return Level(scene, z, least, tops).run();
}

}  // namespace riffler::plan
