// Damping and friction of an identified pen by posture: what its largest passive stiffness follows from.
#pragma once

#include "riffler/geom/vec.hpp"
#include "riffler/pen/arms/geometry.hpp"

namespace riffler::stress {

struct IdentifiedDamping {
  /// N·s/mm: of the grip's pivot in the direction that is damped least, at home and in random postures of the
  /// workspace.
  double home = 0, median = 0, worst = 0;
  double step = 0;      ///< mm: of all encoders together, in the worst posture
  double friction = 0;  ///< N: dry friction in any direction, in the worst posture
  int postures = 0;     ///< that were reached
};

/// `postures`: how many to look at. Throws std::invalid_argument if the pen was not identified, or if its arms reach
/// nearly nothing of its workspace.
IdentifiedDamping identified_damping(const pen::PenGeometry& geometry, int postures = 2000);

/// The smallest eigenvalue of a symmetric matrix, to 1e-7 of the largest.
double least_eigenvalue(const Mat3& matrix);

}  // namespace riffler::stress
