// Options and result of a carve.
#pragma once

#include <vector>

#include "riffler/base/progress.hpp"
#include "riffler/dexel/volume.hpp"

namespace riffler::sweep {

/// What a tool does with the material in its swept volume.
enum class CarveMode { Remove, Add };

/// Options of `carve`.
struct CarveOptions {
  /// mm. Maximum error of every span end: along its ray from the exact swept surface or, where the ray grazes the
  /// surface, in space. Only a turning ball may cut too deep (by at most the tolerance); all other cuts are too
  /// shallow. Moves without rotation are exact for any tolerance.
  double tolerance = 0.01;
  /// s, one per move. Empty: compute no force.
  std::vector<double> dt;
  /// N·s/mm³: force per volume removed per second (methods: "Removal force").
  double removal_constant = 0.05;
  Progress progress;
  CarveMode mode = CarveMode::Remove;
  /// Region that must not change; null for none. It has the volume's frame and is not the volume itself.
  const Volume* protect = nullptr;
};

/// Result of each move, measured on the rays that define Volume::volume().
struct Cut {
  std::vector<double> removed;  ///< mm³ removed or, for CarveMode::Add, added; positive in both modes
  std::vector<Vec3> force;      ///< N, on the tool, against its motion; zero without dt
  std::vector<Vec3> torque;     ///< N·mm, about the tip at the end of the move
};

}  // namespace riffler::sweep
