// What the stress run carves: cutters, stocks and moves from the degenerate limits.
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

/// What is extreme about a session's sizes and places.
enum class Setting { Usual, TinyCutter, HugeCutter, FarFromOrigin, kCount };
const char* name(Setting setting);

/// A stock, a cutter for it, and the tolerance that its moves start from.
struct Stage {
  Setting setting;
  dexel::Frame frame;
  Tool tool;
  double tolerance;  ///< mm
  double finest;     ///< mm: tolerances above it could not tell a cut from none, since the cutter is so thin
};
Stage draw_stage(Random& random, const std::string& cutter);

/// What is degenerate about a move.
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

/// `now`: the present stock; `before`: earlier moves of the session.
Move draw_move(Random& random, const Stage& stage, const Volume& now, std::span<const Move> before);

}  // namespace riffler::stress
