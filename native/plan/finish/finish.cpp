#include "riffler/plan/finish.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>

#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/order.hpp"
#include "plan/finish/patterns.hpp"
#include "riffler/base/check.hpp"
#include "riffler/base/parallel.hpp"
#include "riffler/marching/to_mesh.hpp"
#include "riffler/mesh/orient.hpp"
#include "riffler/plan/cc_frame.hpp"

namespace riffler::plan {

namespace {

constexpr double kAbove = 1;           // mm above the stock at which a rapid down ends
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
  if (!(o.min_slope >= 0 && o.min_slope <= o.max_slope && o.max_slope <= kPi / 2 + 1e-9))
    throw std::invalid_argument("slopes must be two angles in rad, 0 ≤ smaller ≤ larger ≤ π/2");
  base::require_positive(o.feed, "feed", base::kPositiveAndFinite);
  base::require_positive(o.plunge, "plunge", base::kPositiveAndFinite);
  if (o.cusp >= 0.5 * tool.diameter()) throw std::invalid_argument("cusp must be less than the tool's radius");
  for (const tool::ProfileSegment& s : tool.profile().segments())
    if (s.centre && o.tolerance < 4 * tool::Profile::kConcaveTolerance && tool.kind() == "profile")
      throw std::invalid_argument(
          "tolerance must be at least 0.004 mm for a profile with arcs: concave ones are cut "
          "as cones within 0.001 mm");
  double widest = 0;
  for (const tool::ProfileSegment& s : tool.profile().segments()) {
    if (s.to.x < widest - 1e-9)
      throw std::invalid_argument(
          "tool: " + tool.name() +
          " narrows above its widest place; finishing from one side "
          "needs a cutter that does not: ball, flat, fillet, taper, cone or a profile like them");
    widest = std::max(widest, s.to.x);
  }
}

/// The rows' frame: z along the tool's axis, x turned by the rows' angle.
Mat3 rows_frame(const Vec3& axis, double angle) {
  const Vec3 z = unit_axis(axis, "axis");
  const CcFrame base = z == Vec3(0, 0, 1) ? CcFrame{} : cc_frame({1, 0, 0}, z);
  const double c = std::cos(angle), s = std::sin(angle);
  return Mat3(c * base.x + s * base.y, c * base.y - s * base.x, base.z);
}

Mesh turned(Mesh mesh, const Mat3& frame) {
  for (Vec3& v : mesh.vertices) v = v * frame;
  return mesh;
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

/// The links between two pieces, one after the other: tips at feed, or none if the tool must go over the clearance
/// plane.
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

/// Appends rows in the rows' frame, and counts.
class Writer {
 public:
  Writer(FinishResult& out, const Mat3& frame, const FinishOptions& options)
      : out_(out), frame_(frame), options_(options) {}

  void to(const Vec3& tip, MoveKind kind) {
    if (!out_.poses.empty() && tip == last_) return;
    const double feed = kind == MoveKind::Rapid ? 0 : kind == MoveKind::Lead ? options_.plunge : options_.feed;
    out_.poses.push_back({frame_ * tip, frame_[2]}), out_.kinds.push_back(kind), out_.feeds.push_back(feed);
    last_ = tip;
  }
  const Vec3& last() const { return last_; }

 private:
  FinishResult& out_;
  const Mat3& frame_;
  const FinishOptions& options_;
  Vec3 last_{0};
};

/// Highest point of part, fixtures and the stock's box along z of the frame.
double top_of(const SetupScene& scene, const Mesh& part, const std::vector<Mesh>& fixtures, const Mat3& frame) {
  double top = mesh::bounds(part).upper.z;
  for (const Mesh& one : fixtures) top = std::max(top, mesh::bounds(one).upper.z);
  const Box3& box = scene.stock.frame().box;
  for (int corner = 0; corner < 8; ++corner)
    top = std::max(
        top, glm::dot(frame[2], Vec3(corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                                     corner & 4 ? box.upper.z : box.lower.z)));
  return top;
}

void write(const std::vector<CutPiece>& pieces, const std::vector<std::vector<Vec3>>& links,
           const std::optional<DropCutter>& stock, double pitch, double plane, Writer& writer, FinishResult& out) {
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const Vec3 first = pieces[k].tips.front();
    if (k == 0 || links[k - 1].empty()) {
      writer.to({first.x, first.y, plane}, MoveKind::Rapid);
      double down = first.z + kAbove;
      if (stock)
        if (const DropCutter::Landing found = (*stock)(first); found.touches)
          down = std::max(down, found.height + pitch + kAbove);
      if (down < plane) writer.to({first.x, first.y, down}, MoveKind::Rapid);
      writer.to(first, MoveKind::Lead);
    }
    for (std::size_t i = 1; i < pieces[k].tips.size(); ++i) writer.to(pieces[k].tips[i], MoveKind::Cut);
    if (!links[k].empty()) {
      ++out.direct;
      for (const Vec3& tip : links[k]) writer.to(tip, MoveKind::Link);
    } else {
      if (k + 1 < pieces.size()) ++out.retracts;
      writer.to({writer.last().x, writer.last().y, plane}, MoveKind::Rapid);
    }
  }
}

std::string why_empty(const PatternRows& rows, const FinishOptions& options) {
  if (!rows.blocked.empty()) return "nothing can be reached: " + rows.blocked.front().reason;
  if (!options.region.empty()) return "no face that is meant lies within the region";
  return "no face of the part that the tool touches is as steep as slopes asks";
}

}  // namespace

FinishResult finish(const SetupScene& scene, const Tool& tool, const FinishOptions& options, const Progress& progress) {
  const Pattern& pattern = pattern_named(options.pattern);
  check(options, tool);
  base::require_length(scene.clearance, "clearance");
  validate(scene.part);
  if (scene.part.empty()) throw std::invalid_argument("part: it has no triangles");
  const Mat3 frame = rows_frame(scene.axis, options.angle);
  const Mesh part = turned(scene.part, frame);
  std::vector<Mesh> fixtures;
  for (const Mesh& one : scene.fixtures) validate(one), fixtures.push_back(turned(one, frame));
  const FinishSurface surface(part, fixtures, tool, options, region_in(options.region, frame));
  const CutterProfile profile(tool);
  PatternRows rows = pattern.rows({surface, profile, tool, options, mesh::bounds(part)}, base::part(progress, 0, 0.8));
  FinishResult out;
  out.blocked = rows.blocked, out.rows = rows.rows, out.added = rows.added;
  for (BlockedPlace& one : out.blocked) one.place = frame * one.place;
  if (rows.pieces.empty()) {
    out.reason = why_empty(rows, options), out.drops = surface.drops();
    base::report(progress, 1);
    return out;
  }
  const std::vector<CutPiece> pieces = in_short_order(std::move(rows.pieces));
  const double longest = std::max(kDirectSpacings * rows.spacing, profile.radius());
  const auto links = direct_links(pieces, surface, longest, base::part(progress, 0.8, 0.9));
  std::optional<DropCutter> stock;
  if (const Mesh left = turned(marching::to_mesh(scene.stock), frame); !left.empty()) stock.emplace(left, tool);
  Writer writer(out, frame, options);
  write(pieces, links, stock, scene.stock.frame().pitch, top_of(scene, part, fixtures, frame) + scene.clearance, writer,
        out);
  out.drops = surface.drops();
  base::report(progress, 1);
  return out;
}

}  // namespace riffler::plan
