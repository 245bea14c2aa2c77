// Rejects rays that a step certainly does not reach, with a few multiplications per ray.
//
// A tool mostly moves away from what its last step left, so half of the rays under it lose nothing. If a supporting
// plane of the body that faces downwards separates it from the highest point of a ray's material, it separates all of
// the ray's material.
#pragma once

#include "riffler/geom/pose.hpp"
#include "sweep/footprint.hpp"
#include "sweep/straight_part.hpp"
#include "sweep/turning_part.hpp"

namespace riffler::sweep {

struct QuickReject {
  enum class Kind : unsigned char { None, Ball, BallAndFlank, Planes } kind = Kind::None;
  /// A ball on a straight path.
  double from[3], way[3];  ///< centre and displacement
  double per_square;       ///< inverse square of the displacement's length, or 0
  double square;           ///< of the radius, with a margin for rounding
  /// Bounds the rest of the tool, above the ball: no part of it is farther out than the ball in directions whose sine
  /// against the axis is at most −lean.
  double axis[3], lean;
  /// The tool's lower end at both poses, with normals into the tool. A point stays below it during the step if its
  /// heights over both planes are less than −slack − per_depth × its distance from their feet along the rays.
  double foot[2][3], normal[2][3];
  double slack, per_depth;

  QuickReject() = default;
  explicit QuickReject(const StraightBody& body);
  QuickReject(const ConvexGroup& group, const Motion& motion, double t0, double t1, const Footprint& footprint);

 private:
  void set_plane(int k, const Vec3& at, const Vec3& up);
};

}  // namespace riffler::sweep
