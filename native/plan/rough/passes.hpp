// Passes of a cutter along a curve that it cuts a layer along.
#pragma once

#include <cstddef>
#include <vector>

#include "plan/contours.hpp"
#include "plan/rough/layer.hpp"

namespace riffler::plan {

/// A path of the cutter, whose start is free of material; or a closed curve, not repeating its first point, that it
/// cuts all along and may begin anywhere: then `round_from` gives the path.
struct Pass {
  std::vector<Vec2> path;
  bool round = false;
};

/// Where passes run; lengths in mm.
struct PassScene {
  const PlaceGrid& grid;
  const PlaceSet& in;  ///< places that the cutter may be at
  double side;         ///< 1: places to the left of the curves are cleared, −1: those to the right
  double step;         ///< how far from the curves they are
  double ramp;         ///< length along which a pass goes from there to the curve
  double radius;       ///< of the cutter
  double least;        ///< length of a cut that is worth a pass
};

/// Appends the passes along the parts of the curve where the cutter removes something. Where that begins at the curve's
/// end, at a wall, the pass first comes to the wall from the cleared side at an acute angle, and turns back there.
void passes_along(const Curve& curve, const Layer& layer, const PassScene& scene, std::vector<Pass>& out);

/// The path of a round pass from its point `start`: a ramp from the cleared side, once round, and over the ramp again.
std::vector<Vec2> round_from(const Pass& pass, std::size_t start, const PassScene& scene);

}  // namespace riffler::plan
