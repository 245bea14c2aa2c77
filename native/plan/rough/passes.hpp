// Passes of a cutter along a curve that it cuts a layer along.
#pragma once

#include <vector>

#include "plan/contours.hpp"
#include "plan/rough/layer.hpp"

namespace riffler::plan {

/// A path of the cutter, whose start is free of material.
struct Pass {
  std::vector<Vec2> path;
  int after = -1;  ///< index of the pass that must come before it
};

/// Where passes run; lengths in mm.
struct PassScene {
  const PlaceGrid& grid;
  const PlaceSet& in;  ///< places that the cutter may be at
  double side;         ///< 1: places to the left of the curves are cleared, −1: those to the right
  double step;         ///< how far from the curves they are
  double ramp;         ///< length along which a pass goes from there to the curve
  double radius;       ///< of the cutter
};

/// Appends the passes along the parts of the curve where the cutter removes something. Where that begins at the curve's
/// end, at a wall, the first pass goes there from further on: it comes from the cleared side at an acute angle and
/// clears the room in which the second one starts. A closed curve that is cut all along is cut from such a ramp once
/// round, and over the ramp again.
void passes_along(const Curve& curve, const Layer& layer, const PassScene& scene, std::vector<Pass>& out);

}  // namespace riffler::plan
