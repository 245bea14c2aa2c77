// Waterline: level curves of the drop surface. Levels are as far apart as rows on a level face, and nearer wherever two
// levels leave ridges higher than the cusp. Level curves cannot finish level faces, so almost level faces are left out.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/field_rows.hpp"
#include "plan/finish/level_curves.hpp"
#include "plan/finish/patterns.hpp"
#include "riffler/base/parallel.hpp"

namespace riffler::plan {

namespace {

constexpr double kLeastSlope = kPi / 60;  // rad: flatter faces are left to other patterns
constexpr double kLevel = 0.4;            // largest difference in height within a level face, as a share of `over`
constexpr double kOver = 0.05;            // height of a level above a level face, in tolerances
constexpr double kUpright = 1.4;          // rad: smallest slope of walls that are searched for narrow places
constexpr double kGridShare = 0.05;       // of the progress, for each grid
constexpr int kFiner = 2;                 // how often the grid is made finer by kFinerBy for narrow places
constexpr double kFinerBy = 4, kMostFine = 1e6;  // places of a finer grid
constexpr double kMostSamples = 16;              // on the upper edge of a wall's triangle
constexpr const char* kNarrow =
    "waterline: holes and slots only slightly wider than the tool are left out; take a smaller one";
constexpr const char* kFlat = "waterline: faces flatter than 3° are left to another pattern";

/// Spacing of a grid that is fine enough to tell one curve from another, mm.
double grid_spacing(const PatternScene& scene) {
  return std::min(0.5 * scene.profile.spacing(kCuspShare * scene.options.cusp), 0.25 * scene.profile.radius());
}

/// Places next to the selected upright walls of the part where the cutter reaches below the wall's upper edge, and the
/// grid is too coarse to show it: holes and slots that are only a little wider than the cutter.
std::vector<Vec3> unseen_places(const PatternScene& scene, const LevelCurves& curves) {
  const Mesh& mesh = scene.surface.mesh();
  const double tolerance = scene.surface.tolerance(),
               reach = scene.profile.radius() + scene.options.allowance + tolerance;
  const auto unseen = [&](std::size_t triangle) -> std::optional<Vec3> {
    const Vec3i& t = mesh.triangles[triangle];
    std::array<Vec3, 3> v{mesh.vertices[t.x], mesh.vertices[t.y], mesh.vertices[t.z]};
    const Vec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
    const double flat = geom::hypot(normal.x, normal.y);
    if (!(flat > 0) || base::atan2(flat, std::abs(normal.z)) < kUpright) return {};
    if (!scene.surface.wanted_face(static_cast<int>(triangle), (v[0] + v[1] + v[2]) / 3.0,
                                   scene.surface.face_slope(static_cast<int>(triangle))))
      return {};
    std::sort(v.begin(), v.end(), [](const Vec3& a, const Vec3& b) { return a.z > b.z; });
    const Vec2 across = Vec2(normal) / flat, from = Vec2(v[0]), way = Vec2(v[1]) - from;
    const double wide = geom::hypot(way.x, way.y), z = v[0].z - 2 * tolerance;
    const int n = static_cast<int>(std::clamp(std::ceil(wide / reach), 1.0, kMostSamples));
    for (int k = 0; k < n; ++k)
      for (const double side : {reach, -reach}) {
        const Vec2 p = from + (k + 0.5) / n * way + side * across;
        if (!curves.sees_below(p, z) && curves.height(p) <= z) return Vec3(p, z);
      }
    return {};
  };
  std::vector<std::optional<Vec3>> found(scene.surface.part_triangles());
  base::parallel_for(found.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (k % 64 == 0) base::still_wanted();
      found[k] = unseen(k);
    }
  });
  std::vector<Vec3> out;
  for (const std::optional<Vec3>& place : found)
    if (place) out.push_back(*place);
  return out;
}

/// Heights at which a level must lie: the lowest with curves, the highest, and those of level faces at least as large
/// as the cutter.
std::vector<double> special_levels(const PatternScene& scene, const LevelCurves& curves, double over) {
  Field sorted = curves.heights();
  std::sort(sorted.begin(), sorted.end());
  const double lowest = scene.part.lower.z;
  std::vector<double> out;
  if (sorted.front() < lowest) out.push_back(lowest);
  const double radius = scene.profile.radius(), g = curves.grid().spacing;
  const auto enough = static_cast<std::size_t>(kPi * radius * radius / (g * g));
  auto at = std::lower_bound(sorted.begin(), sorted.end(), lowest);
  if (out.empty() && at != sorted.end()) out.push_back(*at + over);
  while (at != sorted.end()) {
    const auto end = std::upper_bound(at, sorted.end(), *at + kLevel * over);
    if (static_cast<std::size_t>(end - at) >= enough) out.push_back(*at + over);
    at = end;
  }
  out.push_back(sorted.back());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end(), [&](double a, double b) { return b - a < over; }), out.end());
  return out;
}

std::vector<double> first_levels(const std::vector<double>& special, double step) {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < special.size(); ++k) {
    const double height = special[k + 1] - special[k];
    const int n = std::max(1, static_cast<int>(std::ceil(height / step - 1e-9)));
    for (int i = 0; i < n; ++i) out.push_back(special[k] + height * i / n);
  }
  return out;
}

std::string why_none(const PatternScene& scene, double least) {
  char text[200];
  const double degrees = least * 180 / kPi;
  if (scene.surface.steepest_meant() < least)
    std::snprintf(text, sizeof text, "waterline: no face steeper than %.3g° is meant by slopes and region", degrees);
  else
    std::snprintf(
        text, sizeof text,
        "waterline: the tool of %.4g mm touches no face steeper than %.3g° that slopes and region mean; where "
        "walls are too narrow for it, take a smaller one",
        scene.tool.diameter(), degrees);
  return text;
}

}  // namespace

PatternRows waterline_rows(const PatternScene& scene, const Progress& progress) {
  const double least = std::max(kLeastSlope, scene.options.min_slope);
  if (scene.options.max_slope < kLeastSlope)
    throw std::invalid_argument("slopes: waterline finishes faces from 3° on; take parallel, spiral or scallop");
  std::optional<LevelCurves> finest;
  std::vector<Vec3> unseen;
  double spacing = grid_spacing(scene);
  for (int k = 0; k <= kFiner; ++k, spacing /= kFinerBy) {
    const double places = finest ? static_cast<double>(finest->grid().size()) * kFinerBy * kFinerBy : 0;
    if (places > kMostFine) break;
    finest.emplace(scene, spacing, kLeastSlope, base::part(progress, k * kGridShare, (k + 1) * kGridShare));
    if (unseen = unseen_places(scene, *finest); unseen.empty()) break;
  }
  const LevelCurves& curves = *finest;
  const double tolerance = scene.surface.tolerance();
  const auto row = [&](double z, const PlaceSet* near, std::vector<BlockedPlace>& blocked) {
    std::vector<CutPiece> out;
    for (LevelPiece& piece : curves.at(z, near, blocked)) {
      if (!scene.options.climb) std::reverse(piece.tips.begin(), piece.tips.end());
      out.push_back({-z, std::move(piece.tips), piece.closed});
    }
    return out;
  };
  // The lower of two places, and the point of the level's curve between them.
  const auto on_curve = [&](std::size_t a, std::size_t b, double z) {
    if (curves.heights()[a] > z) std::swap(a, b);
    const Vec2 low = curves.grid().place(a);
    return std::pair(low, curves.border(low, curves.grid().place(b), z));
  };
  const auto between = [&](std::size_t a, std::size_t b, double z) -> std::optional<SurfacePoint> {
    const SurfacePoint found = scene.surface.at(on_curve(a, b, z).second);
    if (!found.landing.touches || std::abs(found.tip.z - z) > 8 * tolerance) return {};
    return found;
  };
  const auto foot = [&](std::size_t a, std::size_t b, double z) -> std::optional<SurfacePoint> {
    const auto [low, p] = on_curve(a, b, z);
    // A wall that leans by 0.001 rad is no step at its border: the floor is a little farther out.
    const double far = geom::hypot(low.x - p.x, low.y - p.y);
    const Vec2 out = far > tolerance ? p + tolerance / far * (low - p) : low;
    const double floor = std::max(curves.height(out), scene.part.lower.z);
    if (floor >= z - 8 * tolerance) return {};
    return curves.at_wall(p, floor);
  };
  const std::vector<double> levels = first_levels(special_levels(scene, curves, kOver * tolerance),
                                                  scene.profile.spacing(kCuspShare * scene.options.cusp));
  const RowField field{curves.grid(),
                       curves.heights(),
                       levels,
                       std::max(tolerance, kLeastSlope * scene.options.cusp),
                       kLeastSlope,
                       kPi,
                       0.5 * tolerance,
                       scene.options.min_slope < kLeastSlope ? kFlat : nullptr,
                       row,
                       between,
                       foot};
  PatternRows out = field_rows(scene, field, base::part(progress, (kFiner + 1) * kGridShare, 1));
  if (!unseen.empty()) add_blocked({{kNarrow, unseen.front(), 0}}, out.blocked);
  out.descending = true, out.least_slope = least;
  if (out.pieces.empty()) out.reason = why_none(scene, least);
  return out;
}

}  // namespace riffler::plan
