#include "riffler/plan/rough.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>

#include "geom/math.hpp"
#include "plan/operation_moves.hpp"
#include "plan/rough/level.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::plan {

namespace {

constexpr double kMostPlaces = 4e6;
constexpr double kRampDiameters = 1.5;  // length of a ramp from one ring to the next
constexpr double kHelix = 0.45;         // radius of a helix in diameters
constexpr double kLeastLayer = 0.02;    // of the stepdown: thinner material stays
constexpr double kLevel = 1e-6;         // mm by which places of a level face may differ

void check(const RoughOptions& o, const Tool& tool) {
  base::require_length(o.stepdown, "stepdown");
  base::require_tolerance(o.tolerance);
  base::require_tolerance_for(o.tolerance, tool.length() + tool.diameter());
  base::require_not_negative(o.allowance, "allowance", base::kFiniteAndNotNegative);
  if (!(o.engagement >= 0.02 && o.engagement <= 1))
    throw std::invalid_argument("engagement must be a share of the diameter from 0.02 to 1, not " +
                                std::to_string(o.engagement));
  if (!(o.slope > 0 && o.slope <= kPi / 4)) throw std::invalid_argument("slope must be above 0 and at most π/4 rad");
  base::require_positive(o.feed, "feed", base::kPositiveAndFinite);
  base::require_positive(o.plunge, "plunge", base::kPositiveAndFinite);
  if (o.stepdown > tool.length())
    throw std::invalid_argument("stepdown: " + std::to_string(o.stepdown) + " mm is more than the cutter's length, " +
                                std::to_string(tool.length()) + " mm");
  require_upright_cutter(tool, "roughing");
}

/// Places over the stock, and all around it as far as the cutter reaches.
PlaceGrid grid_over(const Box3& stock, double radius, double spacing) {
  PlaceGrid grid;
  grid.spacing = spacing;
  const double around = radius + 3 * spacing;
  grid.lower = Vec2(stock.lower) - around;
  const Vec2 size = Vec2(stock.upper) - Vec2(stock.lower) + 2 * around;
  const double places = (size.x / spacing + 2) * (size.y / spacing + 2);
  if (!(places <= kMostPlaces))
    throw std::invalid_argument("tool: so small for this stock that roughing needs " + std::to_string(places / 1e6) +
                                " million places; take a larger one, or a larger engagement");
  grid.columns = static_cast<int>(std::ceil(size.x / spacing)) + 1;
  grid.rows = static_cast<int>(std::ceil(size.y / spacing)) + 1;
  return grid;
}

/// Heights of a cutter that is let down over all places; −∞ where it touches nothing.
Field heights(const PlaceGrid& grid, const DropCutter& drop, const Progress& progress) {
  Field out(grid.size(), -kInfinity);
  base::parallel_for(
      out.size(), 1024,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
          if (const DropCutter::Landing found = drop(Vec3(grid.place(k), 0)); found.touches) out[k] = found.height;
      },
      progress);
  return out;
}

/// Radius of the cutter at a height above its tip.
double radius_at(const CutterProfile& profile, double height) {
  double low = 0, high = profile.radius();
  if (profile.height(high) <= height) return high;
  for (int k = 0; k < 48; ++k) {
    const double middle = 0.5 * (low + high);
    (profile.height(middle) <= height ? low : high) = middle;
  }
  return low;
}

/// Heights of the levels, descending: one every stepdown from the bottom, so that they are the same for what is left of
/// a stock, and one on each level face of part and allowance that is as large as the cutter.
std::vector<double> level_heights(const PlaceGrid& grid, Field drop, double top, double bottom, double stepdown,
                                  double radius) {
  std::vector<double> out;
  for (int k = 0; bottom + k * stepdown < top - kLeastLayer * stepdown; ++k) out.push_back(bottom + k * stepdown);
  std::sort(drop.begin(), drop.end());
  const auto enough = static_cast<std::size_t>(kPi * radius * radius / (grid.spacing * grid.spacing));
  for (std::size_t k = 0; k + enough < drop.size();) {
    const double z = drop[k + enough];
    if (z > bottom && z < top && z - drop[k] <= kLevel) {
      while (k < drop.size() && drop[k] <= z + kLevel) ++k;
      out.push_back(drop[k - 1]);
    } else {
      ++k;
    }
  }
  std::sort(out.begin(), out.end(), std::greater<>());
  const auto near = [&](double a, double b) { return a - b < kLeastLayer * stepdown; };
  out.erase(std::unique(out.begin(), out.end(), near), out.end());
  return out;
}

/// Writes the levels' moves. Where the drop surface rises above a move, the tool goes over it.
class Writer {
 public:
  Writer(RoughResult& out, const TurnedScene& scene, const DropCutter& part, const RoughOptions& options)
      : out_(out), part_(part), plane_(scene.plane), moves_(out, scene.frame, options.feed, options.plunge) {}

  void write(const LevelRuns& level) {
    for (const LevelRun& run : level.runs) {
      if (!run.linked) {
        if (!out_.poses.empty()) moves_.retract(plane_), ++out_.retracts;
        moves_.approach(run.tips.front(), plane_, std::max(run.top, run.tips.front().z) + kAbove);
      } else {
        ++out_.direct;
        over(run.tips.front(), MoveKind::Link);
      }
      for (std::size_t i = 1; i < run.tips.size(); ++i) over(run.tips[i], run.kinds[i]);
    }
  }
  void end() {
    if (!out_.poses.empty()) moves_.retract(plane_);
  }

 private:
  void over(const Vec3& tip, MoveKind kind) {
    const Vec3 from = moves_.last();
    if (const double above = part_.rise(from, tip, 0).above; above > 0) {
      const double up = above + 1e-9;
      moves_.to(from + Vec3(0, 0, up), MoveKind::Lead), moves_.to(tip + Vec3(0, 0, up), MoveKind::Lead);
    }
    moves_.to(tip, kind);
  }

  RoughResult& out_;
  const DropCutter& part_;
  double plane_;
  MoveWriter moves_;
};

}  // namespace

RoughResult rough(const SetupScene& scene, const Tool& tool, const RoughOptions& options, const Progress& progress) {
  check(options, tool);
  const TurnedScene in = turned(scene, 0);
  RoughResult out;
  const Mesh left = turned_stock(scene, in.frame);
  if (left.empty()) {
    out.reason = "nothing is left of the stock";
    base::report(progress, 1);
    return out;
  }
  const CutterProfile profile(tool);
  const double widest = options.engagement * tool.diameter(), spacing = std::max(widest / 12, tool.diameter() / 40);
  const Box3 stock = mesh::bounds(left);
  const PlaceGrid grid = grid_over(stock, profile.radius(), spacing);
  const Mesh part = joined(in.part, in.fixtures);
  const DropCutter exact(part, tool, {0, 0, 1}, options.allowance),
      wide(part, tool, {0, 0, 1}, options.allowance + 0.5 * options.tolerance);
  const Field drop = heights(grid, wide, base::part(progress, 0, 0.3));
  const DropCutter pin(left, cutters::flat(2 * kCellRadius * grid.spacing, 2 * tool.length()));
  StockTops tops(grid, heights(grid, pin, base::part(progress, 0.3, 0.5)), profile);
  out.drops = 2 * grid.size();
  const double top = *std::max_element(tops.tops().begin(), tops.tops().end()),
               bottom = std::max(stock.lower.z, mesh::bounds(in.part).lower.z);
  const LevelScene level{grid,
                         drop,
                         wide,
                         radius_at(profile, options.stepdown),
                         std::max(widest - 2 * spacing, 0.5 * widest),
                         std::max(widest - spacing, 0.5 * widest),  // widths are measured in cells
                         kRampDiameters * tool.diameter(),
                         kHelix * tool.diameter(),
                         options.slope,
                         0.6 * scene.stock.frame().pitch + 2 * kCellRadius * grid.spacing + options.tolerance,
                         0.25 * options.tolerance,
                         options.climb};
  Writer writer(out, in, exact, options);
  const Progress levels = base::part(progress, 0.5, 1);
  double cut = 0;
  for (const double z : level_heights(grid, drop, top, bottom, options.stepdown, profile.radius())) {
    base::report(levels, (top - z) / (top - bottom));
    LevelRuns runs = level_runs(level, z, kLeastLayer * options.stepdown, tops);
    if (runs.runs.empty()) continue;
    ++out.levels, out.rings += runs.rings, out.helices += runs.helices;
    cut = std::max(cut, runs.widest);
    if (runs.plunges > 0)
      out.blocked.push_back({"too narrow for a helix: the tool plunges", in.frame * runs.plunge, 0});
    writer.write(runs);
  }
  writer.end();
  out.engagement = cut / tool.diameter();
  if (out.poses.empty()) out.reason = "the tool reaches no material above part and allowance";
  base::report(progress, 1);
  return out;
}

}  // namespace riffler::plan
