#include "riffler/plan/finish.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/leads.hpp"
#include "plan/finish/order.hpp"
#include "plan/finish/oriented.hpp"
#include "plan/finish/patterns.hpp"
#include "plan/finish/uncut_faces.hpp"
#include "plan/operation_moves.hpp"
#include "plan/row_axes.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/tool/cutters.hpp"

namespace riffler::plan {

namespace {

constexpr double kLeadShare = 0.5;     // radius of arcs without the option, as a share of the cutter's
constexpr double kDirectSpacings = 3;  // links at feed are at most so many spacings of rows long, or the tool's radius

const Pattern& pattern_named(const std::string& name) {
  const auto& table = patterns();
  const auto found = std::find_if(table.begin(), table.end(), [&](const Pattern& p) { return name == p.name; });
  if (found != table.end()) return *found;
  std::string names;
  for (const Pattern& p : table) names += (names.empty() ? "" : ", ") + std::string(p.name);
  throw std::invalid_argument("pattern must be one of " + names + ", not '" + name + "'");
}

void check(const FinishOptions& o, const Tool& tool) {
  base::require_length(o.cusp, "cusp");
  base::require_tolerance(o.tolerance);
  base::require_tolerance_for(o.tolerance, tool.length() + tool.diameter());
  base::require_not_negative(o.allowance, "allowance", base::kFiniteAndNotNegative);
  base::require_angle(o.angle, "angle");
  if (o.centre && !geom::finite(*o.centre)) throw std::invalid_argument("centre must be three finite numbers");
  if (!(o.min_slope >= 0 && o.min_slope <= o.max_slope && o.max_slope <= kPi / 2 + 1e-9))
    throw std::invalid_argument("slopes must be two angles in rad, 0 ≤ smaller ≤ larger ≤ π/2");
  base::require_positive(o.feed, "feed", base::kPositiveAndFinite);
  base::require_positive(o.plunge, "plunge", base::kPositiveAndFinite);
  if (o.lead) base::require_not_negative(*o.lead, "lead", base::kFiniteAndNotNegative);
  if (o.cusp >= 0.5 * tool.diameter()) throw std::invalid_argument("cusp must be less than the tool's radius");
  for (const tool::ProfileSegment& s : tool.profile().segments())
    if (s.centre && o.tolerance < 4 * tool::Profile::kConcaveTolerance && tool.kind() == "profile")
      throw std::invalid_argument(
          "tolerance must be at least 0.004 mm for a profile with arcs: concave ones are cut "
          "as cones within 0.001 mm");
  require_upright_cutter(tool, "finishing");
}

std::vector<std::vector<Vec2>> region_in(const std::vector<std::vector<Vec3>>& curves, const Mat3& frame) {
  std::vector<std::vector<Vec2>> out;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const std::string name = "region, curve " + std::to_string(k);
    if (curves[k].size() < 3) throw std::invalid_argument(name + " has fewer than three points");
    std::vector<Vec2>& curve = out.emplace_back();
    for (const Vec3& p : curves[k]) {
      if (!geom::finite(p)) throw std::invalid_argument(name + " has a point that is not finite");
      curve.emplace_back(p * frame);
    }
  }
  return out;
}

/// The links from each piece to the next: tips at feed, or none if the tool must move over the clearance plane.
std::vector<std::vector<Vec3>> direct_links(const std::vector<CutPiece>& pieces, const FinishSurface& surface,
                                            double longest, const Progress& progress) {
  std::vector<std::vector<Vec3>> out(pieces.size());
  base::parallel_for(
      pieces.empty() ? 0 : pieces.size() - 1, 4,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
          const Vec3 from = pieces[k].tips.back(), to = pieces[k + 1].tips.front();
          if (geom::hypot(to.x - from.x, to.y - from.y) > longest) continue;
          const std::vector<SurfacePoint> way = surface.follow(Vec2(from), Vec2(to));
          const bool clear = std::all_of(way.begin(), way.end(), [&](const SurfacePoint& p) {
            return p.landing.touches && !p.gap && !surface.blocked(p);
          });
          if (!clear) continue;
          for (const SurfacePoint& p : way) out[k].push_back(p.tip);
          out[k].push_back(to);
        }
      },
      progress);
  return out;
}

/// The links between pieces that follow a wall downwards: straight, or level and then down, if nothing obstructs the
/// tool.
std::vector<std::vector<Vec3>> straight_links(const std::vector<CutPiece>& pieces, const FinishSurface& surface,
                                              double longest) {
  std::vector<std::vector<Vec3>> out(pieces.size());
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const Vec3 from = pieces[k].tips.back(), to = pieces[k + 1].tips.front();
    if (to.z > from.z || geom::hypot(to.x - from.x, to.y - from.y) > longest) continue;
    const Vec3 over(to.x, to.y, from.z);  // moves away first from a wall that bulges outwards
    if (surface.above(from, to) <= 0)
      out[k] = {to};
    else if (surface.above(from, over) <= 0 && surface.above(over, to) <= 0)
      out[k] = {over, to};
  }
  return out;
}

void write(const std::vector<CutPiece>& pieces, const std::vector<std::vector<Vec3>>& links, const Leads& leads,
           const std::optional<DropCutter>& stock, double pitch, double plane, MoveWriter& writer, FinishResult& out) {
  const auto count = [&](const std::vector<Vec3>& arc) { ++(arc.empty() ? out.straight : out.arcs); };
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    if (k == 0 || links[k - 1].empty()) {
      std::vector<Vec3> arc = leads.in(pieces[k]);
      count(arc);
      arc.push_back(pieces[k].tips.front());
      const Vec3 first = arc.front();
      double down = first.z + kAbove;
      if (stock)
        if (const DropCutter::Landing found = (*stock)(first); found.touches)
          down = std::max(down, found.height + pitch + kAbove);
      writer.approach(first, plane, down);
      for (const Vec3& tip : arc) writer.to(tip, MoveKind::Lead);
    }
    for (std::size_t i = 1; i < pieces[k].tips.size(); ++i) writer.to(pieces[k].tips[i], MoveKind::Cut);
    if (!links[k].empty()) {
      ++out.direct;
      for (const Vec3& tip : links[k]) writer.to(tip, MoveKind::Link);
    } else {
      const std::vector<Vec3> arc = leads.out(pieces[k]);
      count(arc);
      for (const Vec3& tip : arc) writer.to(tip, MoveKind::Lead);
      if (k + 1 < pieces.size()) ++out.retracts;
      writer.retract(plane);
    }
  }
}

std::string why_empty(const PatternRows& rows, const FinishOptions& options) {
  if (!rows.reason.empty()) return rows.reason;
  if (!rows.blocked.empty()) return "nothing can be reached: " + rows.blocked.front().reason;
  if (!options.region.empty() || !options.faces.empty()) return "no face that is meant lies within the region";
  return "no face of the part that the tool touches is as steep as slopes asks";
}

/// The tool whose rows are found: the ball at the tip alone if axes change, because tilting may clear all else.
Tool tool_of_rows(const Tool& tool, const FinishOptions& options) {
  if (!options.axes) return tool;
  validate(*options.axes);
  const double radius = ball_for_rows(tool);
  return cutters::ball(2 * radius, std::max(tool.length(), 2 * radius));
}

}  // namespace

FinishResult finish(const SetupScene& scene, const Tool& given, const FinishOptions& options,
                    const Progress& progress) {
  const Pattern& pattern = pattern_named(options.pattern);
  const Tool tool = tool_of_rows(given, options);
  check(options, tool);
  const TurnedScene turned_scene = turned(scene, options.angle);
  const Mat3& frame = turned_scene.frame;
  const Mesh& part = turned_scene.part;
  const FinishSurface surface(part, turned_scene.fixtures, tool, options, region_in(options.region, frame));
  const CutterProfile profile(tool);
  const double found = options.axes ? 0.4 : 0.8;  // share of the progress
  std::optional<Vec2> centre;
  if (options.centre) centre = Vec2(*options.centre * frame);
  const PatternScene pattern_scene{surface, profile, tool, options, mesh::bounds(part), centre};
  PatternRows rows = pattern.rows(pattern_scene, base::part(progress, 0, 0.8 * found));
  cut_uncut_faces(pattern_scene, rows, base::part(progress, 0.8 * found, found));
  FinishResult out;
  out.blocked = rows.blocked, out.rows = rows.rows, out.added = rows.added;
  for (BlockedPlace& one : out.blocked) one.place = frame * one.place;
  if (rows.pieces.empty()) {
    out.reason = why_empty(rows, options), out.drops = surface.drops();
    base::report(progress, 1);
    return out;
  }
  const double longest = std::max(kDirectSpacings * rows.spacing, profile.radius());
  const std::vector<CutPiece> pieces =
      rows.descending ? descending(std::move(rows.pieces), longest) : in_short_order(std::move(rows.pieces));
  const Progress linking = base::part(progress, found, found + 0.1);
  const auto links =
      rows.descending ? straight_links(pieces, surface, longest) : direct_links(pieces, surface, longest, linking);
  if (options.axes) {
    cut_oriented(scene, given, options, frame, pieces, links, base::part(progress, found + 0.1, 1), out);
    out.drops = surface.drops();
    return out;
  }
  const Mesh left = turned_stock(scene, frame);
  std::optional<DropCutter> stock;
  if (!left.empty()) stock.emplace(left, tool);
  const Leads leads(surface, tool, options.lead.value_or(kLeadShare * profile.radius()), rows.descending, left);
  MoveWriter writer(out, frame, options.feed, options.plunge);
  write(pieces, links, leads, stock, scene.stock.frame().pitch, turned_scene.plane, writer, out);
  out.drops = surface.drops();
  base::report(progress, 1);
  return out;
}

}  // namespace riffler::plan
