// Passes: the cutter's paths along a curve in a layer.
#pragma once

#include <cstddef>
#include <vector>

#include "plan/contours.hpp"
#include "plan/rough/layer.hpp"

namespace riffler::plan {

/// A path of the cutter whose start is free of material. Or, if `round`, a closed curve without its first point
/// repeated, along which the cutter cuts everywhere; it may begin at any point, and `round_from` makes the path.
struct Pass {
  std::vector<Vec2> path;
  bool round = false;
};

/// Data that passes need; lengths in mm.
struct PassScene {
  const PlaceGrid& grid;
  const PlaceSet& in;  ///< places where the cutter may be
  double side;         ///< 1: the cleared area is to the left of the curves; −1: to the right
  double step;         ///< distance of the cleared area from the curves
  double ramp;         ///< length along which a pass goes from the cleared area to the curve
  double radius;       ///< of the cutter
  double least;        ///< length of the shortest cut that gets a pass
};

/// Appends the passes along the parts of the curve where the cutter removes material. Where such a part begins at the
/// curve's end, at a wall, the pass first comes to the wall from the cleared side at an acute angle, and turns back
/// there.
void passes_along(const Curve& curve, const Layer& layer, const PassScene& scene, std::vector<Pass>& out);

/// The path of a round pass from its point `start`: a ramp from the cleared side, once round, and along the
/// ramp's length again.
std::vector<Vec2> round_from(const Pass& pass, std::size_t start, const PassScene& scene);

}  // namespace riffler::plan
