// Parallel rows: as far apart as the cusp allows on level faces, with further rows between two of them wherever these
// leave higher ridges.
#include <cmath>
#include <stdexcept>
#include <string>

#include "plan/finish/patterns.hpp"
#include "plan/finish/row_family.hpp"

namespace riffler::plan {

namespace {

constexpr double kChecksInSpacing = 4;  // samples along a row in one spacing of the rows
constexpr double kMaxRows = 1e6;

}  // namespace

PatternRows parallel_rows(const PatternScene& scene, const Progress& progress) {
  const double reach = scene.profile.radius() + scene.options.allowance,
               spacing = scene.profile.spacing(kCuspShare * scene.options.cusp);
  const double lowest = scene.part.lower.y - reach, count = std::ceil((scene.part.upper.y + reach - lowest) / spacing);
  RowFamily family{scene.part.lower.x - reach, scene.part.upper.x + reach, spacing / kChecksInSpacing, {}};
  if (!(count <= kMaxRows && (family.to - family.from) / family.step * count < 4e9))
    throw std::invalid_argument("cusp: " + std::to_string(scene.options.cusp) +
                                " mm needs too many rows for this tool and part; take a larger one");
  for (int k = 0; k <= static_cast<int>(count); ++k) family.first.push_back(lowest + k * spacing);
  family.at = [](double u, double v) { return Vec2(u, v); };
  family.along = [](const Vec2& p, double) { return p.x; };
  family.apart = [](double, double v0, double v1) { return v1 - v0; };
  family.pace = [](double, double) { return 1.0; };
  return family_rows(scene, family, progress);
}

}  // namespace riffler::plan
