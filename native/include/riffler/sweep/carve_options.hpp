// How a carve is to go, and what it did.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::sweep {

/// What a tool does where it sweeps: takes material away, or puts it on.
enum class CarveMode { Remove, Add };

struct CarveOptions {
  /// mm: every interval end lies within it, along its ray, of the exact swept surface; where the ray grazes, within it
  /// in space. Only a turning ball may be cut too deep within it, everything else too shallow. Moves without rotation
  /// are exact whatever it is.
  double tolerance = 0.01;
  /// s, one per move, or empty: no force.
  std::vector<double> dt;
  /// N·s/mm³: force per volume removed per second (methods: "Removal force").
  double removal_constant = 0.05;
  Progress progress;
  CarveMode mode = CarveMode::Remove;
  /// Region that must not change; null for none. It has the volume's frame and is not the volume itself.
  const Volume* protect = nullptr;
};

/// What each move took away, or put on, from the rays that define Volume::volume().
struct Cut {
  std::vector<double> removed;  ///< mm³; of CarveMode::Add what was put on, positive too
  std::vector<Vec3> force;      ///< N, on the tool, against its motion; zero unless dt was given
  std::vector<Vec3> torque;     ///< N·mm about the tip at the end of the move
};

}  // namespace riffler::sweep
