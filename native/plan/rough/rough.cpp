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
constexpr double kRampDiameters = 1.5;   // length of a ramp from one ring to the next, in diameters
constexpr double kSlotDiameters = 2;     // length of a ramp down into a slot, in diameters
constexpr double kRapid = 10'000;        // mm/min, of the rapids that links are compared with
constexpr double kStops = 0.5 / 60;      // min: time of a machine's stops in rapids up, across and down
constexpr double kLeastSlope = 0.001;    // rad: flatter helices would make the program too long
constexpr std::size_t kChunk = 1 << 18;  // number of places whose drops are in memory at a time
constexpr double kHelix = 0.45;          // radius of a helix, in diameters
constexpr double kLeastLayer = 0.02;     // material that is less high stays, in stepdowns
constexpr double kLevel = 0.1;           // largest difference in height within a level face, in tolerances

void check(const RoughOptions& o, const Tool& tool) {
  base::require_length(o.stepdown, "stepdown");
  base::require_tolerance(o.tolerance);
  base::require_tolerance_for(o.tolerance, tool.length() + tool.diameter());
  base::require_not_negative(o.allowance, "allowance", base::kFiniteAndNotNegative);
  if (!(o.engagement >= 0.02 && o.engagement <= 1))
    throw std::invalid_argument("engagement must be a share of the diameter from 0.02 to 1, not " +
                                std::to_string(o.engagement));
  if (!(o.slope >= kLeastSlope && o.slope <= kPi / 4))
    throw std::invalid_argument("slope must be from 0.001 to π/4 rad, not " + std::to_string(o.slope));
  base::require_not_negative(o.depth, "depth", base::kFiniteAndNotNegative);
  base::require_positive(o.feed, "feed", base::kPositiveAndFinite);
  base::require_positive(o.plunge, "plunge", base::kPositiveAndFinite);
  if (o.stepdown > tool.length())
    throw std::invalid_argument("stepdown: " + std::to_string(o.stepdown) + " mm is more than the cutter's length, " +
                                std::to_string(tool.length()) + " mm");
  require_upright_cutter(tool, "roughing");
}

/// A grid of places over the stock and around it, as far as the cutter reaches.
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

/// Heights of a cutter that is lowered at all places; −∞ where it touches nothing.
Field heights(const PlaceGrid& grid, const DropCutter& drop, const Progress& progress) {
  Field out;
  out.reserve(grid.size());
  while (out.size() < grid.size()) {
    const std::size_t begin = out.size(), end = std::min(begin + kChunk, grid.size());
    std::vector<Vec3> places;
    places.reserve(end - begin);
    for (std::size_t k = begin; k < end; ++k) places.emplace_back(grid.place(k), 0);
    const double share = static_cast<double>(begin) / static_cast<double>(grid.size()),
                 next = static_cast<double>(end) / static_cast<double>(grid.size());
    for (const DropCutter::Landing& found : drop(places, base::part(progress, share, next)))
      out.push_back(found.touches ? found.height : -kInfinity);
  }
  return out;
}

/// The level faces of part and allowance that are at least as large as the cutter: lowest and highest height,
/// ascending. Vertices are often single precision, so a level face may be a little tilted.
std::vector<Interval> level_faces(const PlaceGrid& grid, Field ground, double slack, double radius) {
  std::sort(ground.begin(), ground.end());
  const auto enough = static_cast<std::size_t>(kPi * radius * radius / (grid.spacing * grid.spacing));
  std::vector<Interval> out;
  for (std::size_t k = 0; k + enough < ground.size();) {
    const double low = ground[k], high = ground[k + enough];
    if (std::isfinite(low) && high - low <= slack) {
      while (k < ground.size() && ground[k] <= high + slack) ++k;
      out.push_back({low, ground[k - 1]});
    } else {
      ++k;
    }
  }
  return out;
}

/// Heights of the levels, descending: one every stepdown, counted from the bottom so that they stay the same when part
/// of the stock is already removed, and one where the cutter rests on each level face. `above`: height of the levels
/// over ground, mm.
std::vector<double> level_heights(Field drop, const std::vector<Interval>& faces, double above, double top,
                                  double bottom, double stepdown, double slack) {
  std::vector<double> out;
  for (int k = 0; bottom + k * stepdown < top - kLeastLayer * stepdown; ++k) out.push_back(bottom + k * stepdown);
  std::sort(drop.begin(), drop.end());
  for (const Interval& face : faces) {
    const auto end = std::upper_bound(drop.begin(), drop.end(), face.far + above + slack);
    if (end == drop.begin() || *(end - 1) < face.near + above - slack) continue;  // too narrow for the cutter
    if (const double z = *(end - 1); z > bottom && z < top) out.push_back(z);
  }
  std::sort(out.begin(), out.end(), std::greater<>());
  const auto near = [&](double a, double b) { return a - b < kLeastLayer * stepdown; };
  out.erase(std::unique(out.begin(), out.end(), near), out.end());
  return out;
}

/// Writes the moves of the levels. Where the drop surface rises above a move, the tool moves over it.
class Writer {
 public:
  Writer(RoughResult& out, const TurnedScene& scene, const DropCutter& part, const RoughOptions& options,
         StockTops&& stock)
      : out_(out),
        part_(part),
        plane_(scene.plane),
        slope_(options.slope),
        stock_(std::move(stock)),
        moves_(out, scene.frame, options.feed, options.plunge) {}

  void write(const LevelRuns& level) {
    for (const LevelRun& run : level.runs) {
      const Vec3& first = run.tips.front();
      if (run.linked) {
        ++out_.direct;
      } else {
        if (!out_.poses.empty()) moves_.retract(plane_), ++out_.retracts;
        if (run.entry)
          enter(*run.entry, first.z);
        else
          moves_.approach(first, plane_, std::max(stock_.highest(Vec2(first)), first.z) + kAbove);
      }
      for (std::size_t k = 1; k < run.tips.size(); ++k) {
        stock_.cut(run.tips[k - 1], run.tips[k]);
        over(run.tips[k], run.kinds[k], run.rises[k]);
      }
    }
  }
  void end() {
    if (!out_.poses.empty()) moves_.retract(plane_);
  }

 private:
  void enter(const Entry& entry, double z) {
    double top = z;
    const std::vector<Vec3> low = level_way(entry, z);
    for (const Vec3& tip : low) top = std::max(top, stock_.highest(Vec2(tip)));
    const std::vector<Vec3> way = way_down(entry, top, z, slope_);
    moves_.approach(way.front(), plane_, way.front().z + kAbove);
    for (std::size_t k = 1; k < way.size(); ++k) {
      stock_.cut(way[k - 1], way[k]);
      over(way[k], MoveKind::Lead, part_.rise(way[k - 1], way[k], 0).above);
    }
    if (entry.radius > 0)
      ++out_.helices;
    else
      ++out_.ramps;
  }
  void over(const Vec3& tip, MoveKind kind, double above) {
    if (above > 0) {
      const Vec3 from = moves_.last();
      const double up = above + 1e-9;
      moves_.to(from + Vec3(0, 0, up), MoveKind::Lead), moves_.to(tip + Vec3(0, 0, up), MoveKind::Lead);
    }
    moves_.to(tip, kind);
  }

  RoughResult& out_;
  const DropCutter& part_;
  double plane_, slope_;
  StockTops stock_;
  MoveWriter moves_;
};

/// Adds the areas that are left out to `blocked`. Areas below each other count as one.
void add_blocked(const std::vector<LevelRuns>& levels, std::vector<Vec3> LevelRuns::* places, const char* reason,
                 const Mat3& frame, double near, RoughResult& out) {
  std::vector<Vec2> known;
  for (const LevelRuns& level : levels)
    for (const Vec3& p : level.*places) {
      const auto same = [&](const Vec2& q) { return glm::length(q - Vec2(p)) < near; };
      if (std::any_of(known.begin(), known.end(), same)) continue;
      known.emplace_back(p);
      out.blocked.push_back({reason, frame * p, 0});
    }
}

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
  const Tool cell = cutters::flat(2 * kCellRadius * grid.spacing, 2 * tool.length());
  const DropCutter pin(left, cell);
  const StockTops tops(grid, heights(grid, pin, base::part(progress, 0.3, 0.4)), profile);
  Field ground = heights(grid, DropCutter(part, cell), base::part(progress, 0.4, 0.5));
  for (double& z : ground) z += options.allowance;
  out.drops = 3 * grid.size();
  const Box3 part_box = mesh::bounds(in.part);
  const double top = *std::max_element(tops.tops().begin(), tops.tops().end()),
               lowest = options.depth > 0 ? part_box.upper.z - options.depth : part_box.lower.z,
               bottom = std::max({stock.lower.z, part_box.lower.z, lowest});
  const LevelScene level{grid,
                         drop,
                         ground,
                         wide,
                         exact,
                         tops,
                         profile.radius_at(options.stepdown),
                         profile.radius(),
                         std::max(widest - 2 * spacing, 0.5 * widest),
                         std::max(widest - spacing, 0.5 * widest),  // less a spacing: widths are measured in cells
                         kRampDiameters * tool.diameter(),
                         kHelix * tool.diameter(),
                         kSlotDiameters * tool.diameter(),
                         0.6 * scene.stock.frame().pitch + 2 * kCellRadius * grid.spacing + options.tolerance,
                         0.25 * options.tolerance,
                         options.climb};
  const double slack = kLevel * options.tolerance;
  const std::vector<double> levels = level_heights(drop, level_faces(grid, ground, slack, profile.radius()),
                                                   0.5 * options.tolerance, top, bottom, options.stepdown, slack);
  std::vector<LevelRuns> runs(levels.size());
  base::parallel_for(
      levels.size(), 1,
      [&](std::size_t begin, std::size_t end) {
        const base::SerialScope alone;
        for (std::size_t k = begin; k < end; ++k) {
          const double over = options.feed * (2 * (in.plane - levels[k]) / kRapid + kAbove / options.plunge + kStops);
          runs[k] = level_runs(level, levels[k], kLeastLayer * options.stepdown, over);
        }
      },
      base::part(progress, 0.5, 0.95));
  Writer writer(out, in, exact, options, StockTops(tops));
  double cut = 0;
  for (const LevelRuns& one : runs) {
    if (one.runs.empty()) continue;
    ++out.levels, out.rings += one.rings;
    cut = std::max(cut, one.widest);
    writer.write(one);
  }
  writer.end();
  add_blocked(runs, &LevelRuns::narrow, "too narrow for a helix or a ramp: left out", in.frame, tool.diameter(), out);
  add_blocked(runs, &LevelRuns::holes, "narrower than the tool and allowance: left out", in.frame, tool.diameter(),
              out);
  out.engagement = cut / tool.diameter();
  if (out.poses.empty()) out.reason = "the tool reaches no material above part and allowance";
  base::report(progress, 1);
  return out;
}

}  // namespace riffler::plan
