// Height of the ridge that a cutter leaves between two places.
#pragma once

#include <array>
#include <vector>

#include "plan/lower_side.hpp"
#include "riffler/tool/tool.hpp"

namespace riffler::plan {

/// The lower side of a whole cutter.
class CutterProfile {
 public:
  explicit CutterProfile(const Tool& tool);

  double radius() const { return radius_; }
  /// Height (mm) of the lower side at radius `rho`; infinite beyond the cutter.
  double height(double rho) const;
  /// Radius (mm) of the cutter at `height` above its tip: the largest one whose lower side is no higher.
  double radius_at(double height) const;

  /// Height (mm) of the ridge between two rows of the cutter that are `across` apart horizontally and `up` vertically,
  /// measured from the common tangent of both; infinite where they leave a strip uncut.
  double ridge(double across, double up) const;
  /// The largest distance of rows on a level face that leaves ridges of at most `cusp` mm. Not more than the radius.
  double spacing(double cusp) const;

 private:
  std::vector<LowerSide> sides_;
  std::vector<Vec2> points_;  // of the lower side, (radius, height)
  double radius_ = 0;
};

/// Distance of two rows that leave the cusp, mm, depending on the slope between them.
class RowSteps {
 public:
  RowSteps(const CutterProfile& profile, double cusp);
  /// `across`, `up`: level and upright part of the step from one row to the other, in any unit.
  double operator()(double across, double up) const;

 private:
  static constexpr int kSlopes = 64;
  std::array<double, kSlopes + 1> steps_{};
};

}  // namespace riffler::plan
