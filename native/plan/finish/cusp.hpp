// Height of the ridge that a cutter leaves between two places.
#pragma once

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

}  // namespace riffler::plan
