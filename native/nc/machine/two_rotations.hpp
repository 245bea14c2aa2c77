// Angles of two successive rotations that turn one direction into another.
#pragma once

#include <optional>

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// The angle (rad, −π to π) of the rotation about k that makes `from` point like `to`, seen along k. 0 if either lies
/// on k.
double angle_about(const Vec3& k, const Vec3& from, const Vec3& to);

/// R(first, α) R(second, β), the rotations of two axes; `second` turns with the first.
struct TwoRotations {
  Vec3 first, second;  ///< unit, not parallel

  struct Angles {
    double alpha, beta;  ///< rad
  };
  /// One of the two solutions (`branch` 0 and 1) that turn `from` into `to`, both unit vectors (Paden and Kahan's
  /// second subproblem; Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, 3.3.2). No
  /// value if the axes cannot reach `to`. Accurate also near `first`, where `to` does not determine alpha, which is
  /// then 0.
  std::optional<Angles> angles(const Vec3& from, const Vec3& to, int branch) const;
};

}  // namespace riffler::nc
