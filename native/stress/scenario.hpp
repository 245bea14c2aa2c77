// Random cutters, stocks and moves from the degenerate limits, for the stress run.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "riffler/dexel/volume.hpp"
#include "riffler/geom/pose.hpp"
#include "riffler/tool/tool.hpp"
#include "stress/random.hpp"

namespace riffler::stress {

/// Names for the command line: ball, flat, fillet, …
std::span<const char* const> cutter_names();

/// Extreme of a session's sizes and places.
enum class Setting { Usual, TinyCutter, HugeCutter, FarFromOrigin, kCount };
const char* name(Setting setting);

/// A stock, a cutter for it, and the base tolerance of its moves.
struct Stage {
  Setting setting;
  dexel::Frame frame;
  Tool tool;
  double tolerance;  ///< mm
  double finest;     ///< mm: largest useful tolerance; above it a cut with so thin a cutter could be lost
};
Stage draw_stage(Random& random, const std::string& cutter);

/// Kind of degeneracy of a move.
enum class Kind {
  Still,
  TinyWay,
  AlongRays,
  AxisAlongRays,
  BothAlongRays,
  WallsOnRays,
  TangentToRay,
  OnLattice,
  OnSurface,
  LongWay,
  Straight,
  TinyAngle,
  Turning,
  AboutPivot,
  EdgeOnToRays,
  NearAntipodal,
  FarOutside,
  Repeated,
  kCount
};
const char* name(Kind kind);

struct Move {
  Kind kind;
  Pose from, to;
  double tolerance;  ///< mm
};

/// Draws a move. `now`: the present stock; `before`: earlier moves of the session.
Move draw_move(Random& random, const Stage& stage, const Volume& now, std::span<const Move> before);

}  // namespace riffler::stress
