// A move of the whole tool → steps: straight or turning parts of convex groups of pieces.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <variant>

#include "geom/pose.hpp"
#include "sweep/footprint.hpp"
#include "sweep/straight_part.hpp"
#include "sweep/turning_part.hpp"

namespace riffler {

struct StraightPart {
  ConvexGroup group;
  StraightBody body;
};

struct TurningPart {
  ConvexGroup group;
  double t0, t1;
};

/// One step of the tool, in the cyclic frame of one grid.
struct Step {
  std::uint32_t move;
  const Motion* motion;
  Footprint footprint;
  std::variant<StraightPart, TurningPart> body;
};

/// Calls `sink` for every step of the cutter on `motion` that can touch `box`, in order of t. Poses, box and steps are
/// in the cyclic frame of one grid; `motion` must outlive the steps. Of a turning ball only the centre's path matters:
/// it is cut as straight steps along chords, by at most `tolerance` beside it.
void for_each_step(std::span<const ConvexGroup> cutter, const Motion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink);

}  // namespace riffler
