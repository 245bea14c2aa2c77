// Patterns about a centre: a spiral from the centre outwards, and rays from the centre.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/functions.hpp"
#include "geom/hypot.hpp"
#include "geom/math.hpp"
#include "plan/finish/patterns.hpp"
#include "plan/finish/row_family.hpp"

namespace riffler::plan {

namespace {

constexpr double kSamplesInSpacing = 4;  // samples along a row in one spacing of the rows
constexpr double kBend = 0.02;           // largest distance of chords from their curve, as a share of the spacing
constexpr double kFirstRays = 16;
constexpr double kMostTurns = 1e5;

double row_spacing(const PatternScene& scene, double far) {
  const double spacing = scene.profile.spacing(kCuspShare * scene.options.cusp);
  if (!(far / spacing < kMostTurns))
    throw std::invalid_argument("cusp: " + std::to_string(scene.options.cusp) +
                                " mm needs too many rows for this tool and part; take a larger one");
  return spacing;
}

}  // namespace

PatternRows spiral_rows(const PatternScene& scene, const Progress& progress) {
  const Vec2 centre = centre_of(scene);
  const double far = farthest_from(scene, centre), pitch = row_spacing(scene, far), whole = 2 * kPi;
  RowFamily family{0, whole, pitch / kSamplesInSpacing / far, {}};
  for (int k = 0; k <= static_cast<int>(std::ceil(far / pitch)); ++k) family.first.push_back(k);
  const auto radius = [=](double u, double v) { return pitch * (v + u / whole); };
  family.at = [=](double u, double v) {
    const double turn = std::min(u, whole);
    return centre + radius(turn, v) * Vec2(base::cos(turn), base::sin(turn));
  };
  family.along = [=](const Vec2& p, double v) {
    const double turn = base::atan2(p.y - centre.y, p.x - centre.x);
    // Near the ends of a turn, the radius decides which turn the point is on.
    const double r = geom::hypot(p.x - centre.x, p.y - centre.y), at = turn < 0 ? turn + whole : turn;
    double best = at;
    for (const double u : {at - whole, at + whole})
      if (std::abs(radius(u, v) - r) < std::abs(radius(best, v) - r)) best = u;
    return std::clamp(best, 0.0, whole);
  };
  family.apart = [=](double, double v0, double v1) { return pitch * (v1 - v0); };
  family.pace = [=](double u, double v) { return std::max(radius(u, v), 0.5 * pitch); };
  family.chord = [=](double u, double v) { return std::sqrt(8 * kBend * pitch / std::max(radius(u, v), 0.5 * pitch)); };
  return family_rows(scene, family, progress);
}

PatternRows radial_rows(const PatternScene& scene, const Progress& progress) {
  const Vec2 centre = centre_of(scene);
  const double far = farthest_from(scene, centre), spacing = row_spacing(scene, far);
  RowFamily family{0, far, spacing / kSamplesInSpacing, {}};
  for (int k = 0; k <= kFirstRays; ++k) family.first.push_back(k / kFirstRays);
  family.ring = true;
  family.at = [=](double u, double v) { return centre + u * Vec2(base::cos(2 * kPi * v), base::sin(2 * kPi * v)); };
  family.along = [=](const Vec2& p, double) { return geom::hypot(p.x - centre.x, p.y - centre.y); };
  family.apart = [](double u, double v0, double v1) { return 2 * kPi * (v1 - v0) * u; };
  family.pace = [](double, double) { return 1.0; };
  return family_rows(scene, family, progress);
}

}  // namespace riffler::plan
