// Minutes of sculpting with the simulated pen, as fast as the machine computes: what a session costs, and whether it
// could run for ever.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "riffler/session/sculpt_loop.hpp"

namespace riffler::stress {

struct SculptingOptions {
  double seconds = 600;
  double pitch = 0.25;  ///< mm, of a stock of 80 × 80 × 30 mm
  std::string directions = "z";
  double stiffness = 1;          ///< N/mm, of the coupling
  bool controlled = true;        ///< by passivity
  bool touch = false;            ///< the hand feels the stock between strokes, which are shorter then
  std::int64_t jitter_us = 200;  ///< of the cable
  double warm = 30;              ///< s after which nothing may be asked of the system
  /// Calls of operator new in this thread so far, in programs that count them.
  std::function<long()> allocations = [] { return 0L; };
  std::function<void(double)> progress = [](double) {};  ///< share that is done
};

struct SculptingRun {
  std::vector<float> step_seconds;  ///< of processor time, of each step after the warm-up
  std::vector<double> resident;     ///< MB that the process held after each tenth of the run
  double removed = 0;               ///< mm³
  /// N·mm: the most that the motors gave in a contact more than they took and the arms' friction lost.
  double gained = 0;
  double given = 0;     ///< N·mm that they took from the hand in all
  double account = 0;   ///< N·mm: the least that the account held
  double greatest = 0;  ///< N: of the force that the hand felt
  std::uint64_t steps = 0, strokes = 0, trips = 0, missed = 0, frames = 0, tiles = 0;
  std::uint64_t touched = 0;      ///< steps in which the hand felt the stock without a cut
  std::uint64_t from_system = 0;  ///< blocks, in steps after the warm-up
  long allocations = 0;           ///< calls of operator new in steps after the warm-up
  bool replayed = false;          ///< what is shown at the end is what its moves leave, to the bit
  std::size_t triangles = 0;      ///< of the mesh that followed
};

/// A ball of 6 mm wanders over the stock, in and out of it, leaning; a mesh follows thirty times a second.
SculptingRun sculpting_run(const SculptingOptions& options);

}  // namespace riffler::stress
