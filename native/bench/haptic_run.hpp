// Strokes of the haptic step: its processor time, and the forces on the hand.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "riffler/geom/vec.hpp"

namespace riffler::bench {

struct HapticOptions {
  /// "cut": a Ø20 ball, sunk to its centre, on overlapping turns, 0.5 mm a step.
  /// "wave": a Ø8 ball that a hand moves into a block and out of it, at up to 40 mm/s.
  /// "slot": a Ø6 flat end that enters a block from the side, 1 to 3 mm deep, and leans to and fro.
  /// "groove": the same with a Ø6 bull nose.
  /// "trace": COL's ball over its part of 200 000 triangles. "fixture": the same past a block of dexels, which the
  /// holder meets.
  /// "bore": a Ø6 ball that circles down in a bore of 720 triangles, each as long as the bore. "box": along the upper
  /// edges and over the corners of a box of 12 triangles. The path of a mesh file: along the pencil paths of the part,
  /// scaled to 100 mm length.
  /// From "trace" on the ball is pressed 1 mm into the part and moves 0.05 mm a step.
  std::string scene = "cut";
  double pitch = 0.1;  ///< mm, of the stock or the fixture
  int steps = 600;     ///< ms of the stroke
  int parts = 1, queries = 2;
  std::optional<double> memory{};  ///< mm; by default that of the step
  /// Factor on the hand's speed in "wave", "slot" and "groove". The material is softer or harder by the same factor, so
  /// that the force is the same.
  double speed = 1;
  std::optional<double> budget{};  ///< s
  /// ms between two steps. Above 1, the force in between is interpolated between the last two; the source's scheme has
  /// 10.
  int period = 1;
};

struct HapticRun {
  std::vector<double> seconds;    ///< processor time of every step
  std::vector<Vec3> force, grip;  ///< N, mm: at every ms
  double removed = 0;             ///< mm³
  double touching = 0, held = 0;  ///< shares of the steps
};

/// Throws std::invalid_argument for an unknown scene.
HapticRun haptic_run(const HapticOptions& options);

}  // namespace riffler::bench
