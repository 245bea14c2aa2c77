// Damping and friction of an identified pen by posture, which determine its largest passive stiffness.
#pragma once

#include "riffler/geom/vec.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::stress {

struct IdentifiedDamping {
  /// N·s/mm: damping of the grip's pivot in the direction of least damping, at home and in random postures of the
  /// workspace.
  double home = 0, median = 0, worst = 0;
  double step = 0;      ///< mm: step of all encoders together, in the worst posture
  double friction = 0;  ///< N: dry friction in any direction, in the worst posture
  int postures = 0;     ///< number of reached postures
};

/// `postures`: number of postures to draw. Throws std::invalid_argument if the pen was not identified, or if its arms
/// reach almost no part of its workspace.
IdentifiedDamping identified_damping(const pen::PenGeometry& geometry, int postures = 2000);

/// The smallest eigenvalue of a symmetric matrix, to 1e-7 of the largest.
double least_eigenvalue(const Mat3& matrix);

}  // namespace riffler::stress
