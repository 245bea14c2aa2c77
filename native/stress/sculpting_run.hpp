// Sculpts with the simulated pen for minutes, as fast as the machine computes. Measures the cost of a session and
// checks that it could run for ever.
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
  double warm = 30;              ///< s after which steps may no longer allocate
  /// Calls of operator new in this thread so far, in programs that count them.
  std::function<long()> allocations = [] { return 0L; };
  std::function<void(double)> progress = [](double) {};  ///< share that is done
};

struct SculptingRun {
  std::vector<float> step_seconds;  ///< of processor time, of each step after the warm-up
  std::vector<double> resident;     ///< MB of resident memory after each tenth of the run
  double removed = 0;               ///< mm³
  /// N·mm: largest energy that motors gave in a contact, less what they took and losses by friction.
  double gained = 0;
  double given = 0;     ///< N·mm: total energy that the hand gave to the motors
  double account = 0;   ///< N·mm: smallest value of the passivity account
  double greatest = 0;  ///< N: largest force on the hand
  std::uint64_t steps = 0, strokes = 0, trips = 0, missed = 0, frames = 0, tiles = 0;
  std::uint64_t touched = 0;      ///< steps in which the hand felt the stock without a cut
  std::uint64_t from_system = 0;  ///< memory blocks taken from the system in steps after the warm-up
  long allocations = 0;           ///< calls of operator new in steps after the warm-up
  bool replayed = false;          ///< the displayed volume equals a replay of the moves, to the bit
  std::size_t triangles = 0;      ///< of the mesh that follows
};

/// Moves a leaning ball of 6 mm over the stock, in and out of it; a mesh follows thirty times a second.
SculptingRun sculpting_run(const SculptingOptions& options);

}  // namespace riffler::stress
