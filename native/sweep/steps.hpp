// Splits a move of the whole tool into steps: straight or turning parts of convex groups of pieces.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <variant>

#include "riffler/dexel/grid.hpp"
#include "riffler/geom/pose.hpp"
#include "sweep/footprint.hpp"
#include "sweep/hull_part.hpp"
#include "sweep/straight_part.hpp"
#include "sweep/turning_part.hpp"

namespace riffler::sweep {

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
  std::variant<StraightPart, TurningPart, HullPart> body;
};

/// The convex group of pieces that a step of a tool of revolution sweeps.
inline const ConvexGroup& group_of(const Step& step) {
  const auto* turning = std::get_if<TurningPart>(&step.body);
  return turning ? turning->group : std::get<StraightPart>(step.body).group;
}

/// A pose in the cyclic frame of a grid whose rays run along `axis`, with a unit axis. Adding 0.0 removes the sign of
/// zeros, which differs in a mirrored pose; no cut may depend on it.
inline Pose to_local(Axis axis, const Pose& p) {
  return {to_local(axis, p.tip) + 0.0, glm::normalize(to_local(axis, p.axis)) + 0.0};
}

/// A block of a grid's tiles: inclusive ranges of rows and columns, empty if a first exceeds its last.
struct TileBlock {
  int row, last_row, column, last_column;
  bool empty() const { return row > last_row || column > last_column; }
};

/// The tiles with rays under a footprint.
TileBlock tiles_under(const dexel::Grid& grid, const Footprint& footprint);

/// Calls `sink`, in order of t, for every step of the cutter on `motion` that can touch `box`. Poses, box and steps are
/// in the cyclic frame of one grid; `motion` must outlive the steps. For a turning ball only the centre's path matters:
/// it is cut in straight steps along chords that deviate from the path by at most `tolerance` (mm).
///
/// A step of a move that turns has the times of the move. That of a move that does not has times of its own, from 0
/// to 1 on the part of the path that is near the box: an end keeps its time in units of 2^-30 (Origins), which would be
/// too coarse for its normal where the move is 1e5 times as long as the tool.
void for_each_step(std::span<const ConvexGroup> cutter, const Motion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink);

}  // namespace riffler::sweep
