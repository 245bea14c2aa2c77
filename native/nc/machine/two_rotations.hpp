// The angles of two rotations, one after the other, that turn one direction into another.
#pragma once

#include <optional>

#include "riffler/geom/vec.hpp"

namespace riffler::nc {

/// The angle (rad, −π to π) by which `from` is turned about k to point like `to`, seen along k. 0 where either lies on
/// k.
double angle_about(const Vec3& k, const Vec3& from, const Vec3& to);

/// R(first, α) R(second, β) = the rotations of two axes; `second` turns with the first.
struct TwoRotations {
  Vec3 first, second;  ///< unit, not parallel

  struct Angles {
    double alpha, beta;  ///< rad
  };
  /// The two ways (`branch` 0 and 1) to turn `from` into `to`, both unit vectors (Paden and Kahan's second subproblem;
  /// Murray, Li and Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, 3.3.2). Nothing where the axes
  /// cannot reach it. Accurate near `first`, too, where alpha is not determined by `to` and is then 0.
  std::optional<Angles> angles(const Vec3& from, const Vec3& to, int branch) const;
};

}  // namespace riffler::nc
