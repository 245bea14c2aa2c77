// Strokes of the haptic step: its processor time, and what the hand feels.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::bench {

struct HapticOptions {
  /// "cut": a Ø20 ball, sunk to its centre, 0.5 mm a step, whose turns overlap. "wave": a Ø8 ball that a hand moves
  /// into a block and out of it, at up to 40 mm/s. "slot": a Ø6 flat end,
  /// sideways into a block, 1 to 3 mm deep, that leans to and fro. "groove": a Ø6 bull nose there. "trace": COL's ball
  /// over its part of 200 000 triangles, pressed 1 mm below it, 0.05 mm a step. "fixture": the same past a block of
  /// dexels, which its holder meets. "bore": a Ø6 ball round and down in a bore of 720 triangles as long as it. "box":
  /// along the upper edges and over the corners of a box of 12 triangles. Any file of a mesh: made 100 mm long, along
  /// its pencil paths. In these three the ball is pressed 1 mm into the part, 0.05 mm a step.
  std::string scene = "cut";
  double pitch = 0.1;  ///< mm, of the stock or the fixture
  int steps = 600;     ///< ms of the stroke
  int parts = 1, queries = 2;
  std::optional<double> memory{};  ///< mm; without one that of the step
  /// Of the hand in "wave", "slot" and "groove", as a share of theirs; the material is as much harder for the force to
  /// be the same.
  double speed = 1;
  std::optional<double> budget{};  ///< s
  /// Steps are made every so many ms, and the force between them is the straight line between the last two where this
  /// is above 1: the source's scheme is 10.
  int period = 1;
};

struct HapticRun {
  std::vector<double> seconds;    ///< of processor time, of every step that was made
  std::vector<Vec3> force, grip;  ///< N, mm: at every ms
  double removed = 0;             ///< mm³
  double touching = 0, held = 0;  ///< shares of the steps
};

/// std::invalid_argument for a scene that there is not.
HapticRun haptic_run(const HapticOptions& options);

}  // namespace riffler::bench
