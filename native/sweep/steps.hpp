// A move of the whole tool → steps: straight or turning parts of convex groups of pieces.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <variant>

#include "riffler/dexel/grid.hpp"
#include "riffler/geom/pose.hpp"
#include "sweep/footprint.hpp"
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
  std::variant<StraightPart, TurningPart> body;
};

/// A pose in the cyclic frame of a grid whose rays run along `axis`; its own axis is made unit. Zeros lose their sign,
/// which a mirrored pose has and no cut may depend on.
inline Pose to_local(Axis axis, const Pose& p) {
  return {to_local(axis, p.tip) + 0.0, glm::normalize(to_local(axis, p.axis)) + 0.0};
}

/// A block of a grid's tiles, by their rows and columns, both ends included; empty where a first is past its last.
struct TileBlock {
  int row, last_row, column, last_column;
  bool empty() const { return row > last_row || column > last_column; }
};

/// The tiles whose rays pass under a footprint.
TileBlock tiles_under(const dexel::Grid& grid, const Footprint& footprint);

/// Calls `sink` for every step of the cutter on `motion` that can touch `box`, in order of t. Poses, box and steps are
/// in the cyclic frame of one grid; `motion` must outlive the steps. Of a turning ball only the centre's path matters:
/// it is cut as straight steps along chords, by at most `tolerance` beside it.
void for_each_step(std::span<const ConvexGroup> cutter, const Motion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink);

}  // namespace riffler::sweep
