// Waterline: level curves of the drop surface. Levels are as far apart as rows on a level face, and nearer wherever two
// levels leave ridges higher than the cusp. Level curves cannot finish level faces, so almost level faces are left out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>

#include "geom/math.hpp"
#include "plan/finish/field_rows.hpp"
#include "plan/finish/level_curves.hpp"
#include "plan/finish/patterns.hpp"

namespace riffler::plan {

namespace {

constexpr double kLeastSlope = kPi / 60;  // rad: flatter faces are left to other patterns
constexpr double kLevel = 1e-6;           // largest difference in height between places of a level face, mm
constexpr double kOver = 0.05;            // height of a level above a level face, in tolerances
constexpr const char* kFlat = "waterline: faces flatter than 3° are left to another pattern";

/// Spacing of a grid that is fine enough to tell one curve from another, mm.
double grid_spacing(const PatternScene& scene) {
  return std::min(0.5 * scene.profile.spacing(kCuspShare * scene.options.cusp), 0.25 * scene.profile.radius());
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
    const auto end = std::upper_bound(at, sorted.end(), *at + kLevel);
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
  const LevelCurves curves(scene, grid_spacing(scene), kLeastSlope, base::part(progress, 0, 0.1));
  const double tolerance = scene.surface.tolerance();
  const auto row = [&](double z, const PlaceSet* near, std::vector<BlockedPlace>& blocked) {
    std::vector<CutPiece> out;
    for (LevelPiece& piece : curves.at(z, near, blocked)) {
      if (!scene.options.climb) std::reverse(piece.tips.begin(), piece.tips.end());
      out.push_back({-z, std::move(piece.tips), piece.closed});
    }
    return out;
  };
  const auto between = [&](std::size_t a, std::size_t b, double z) -> std::optional<SurfacePoint> {
    if (curves.heights()[a] > z) std::swap(a, b);
    const Vec2 p = curves.border(curves.grid().place(a), curves.grid().place(b), z);
    const SurfacePoint found = scene.surface.at(p);
    if (!found.landing.touches || std::abs(found.tip.z - z) > 8 * tolerance) return {};
    return found;
  };
  const RowField field{curves.grid(),
                       curves.heights(),
                       first_levels(special_levels(scene, curves, kOver * tolerance),
                                    scene.profile.spacing(kCuspShare * scene.options.cusp)),
                       std::max(tolerance, kLeastSlope * scene.options.cusp),
                       kLeastSlope,
                       kPi,
                       0.5 * tolerance,
                       scene.options.min_slope < kLeastSlope ? kFlat : nullptr,
                       row,
                       between};
  PatternRows out = field_rows(scene, field, base::part(progress, 0.1, 1));
  out.descending = true;
  if (out.pieces.empty()) out.reason = why_none(scene, least);
  return out;
}

}  // namespace riffler::plan
