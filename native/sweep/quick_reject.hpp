// Rejects rays that a step certainly does not reach, with a few multiplications per ray.
//
// A tool mostly moves away from what its last step left, so half of the rays under it lose nothing. If a supporting
// plane of the body separates it from the highest point of a span below it, or from the lowest point of a span above
// it, it separates the whole span.
#pragma once

#include "riffler/geom/pose.hpp"
#include "sweep/footprint.hpp"
#include "sweep/hull_part.hpp"
#include "sweep/straight_part.hpp"
#include "sweep/turning_part.hpp"

namespace riffler::sweep {

/// A point or a line without ends on a straight path, thickened: a swept ball or tube.
struct SweptLine {
  double from[3], way[3];  ///< a point of it at the start, and its displacement; a line's is perpendicular to the line
  double per_square;       ///< inverse square of the displacement's length, or 0
  double square;           ///< of the radius, with a margin for rounding
  double axis[3];          ///< the line's direction, or the tool's
  bool endless = false;    ///< a line
};

struct QuickReject {
  enum class Kind : unsigned char { None, Ball, BallAndFlank, Planes } kind = Kind::None;
  /// A ball on a straight path.
  SweptLine centre;
  bool alone = false;  ///< the ball is the whole group
  /// Bounds the rest of the tool, above the ball: no part of it is farther out than the ball in directions whose sine
  /// against the axis is at most −lean.
  double lean;
  /// A tube around the whole step, for rays that do not run along the tool's axis.
  SweptLine tube;
  bool has_tube = false;
  /// The tool's lower end at both poses, with normals into the tool. A point stays below it during the step if its
  /// heights over both planes are less than −slack − per_depth × its distance from their feet along the rays.
  double foot[2][3], normal[2][3];
  double slack, per_depth;
  bool has_planes = false;

  QuickReject() = default;
  explicit QuickReject(const StraightBody& body);
  QuickReject(const ConvexGroup& group, const Motion& motion, double t0, double t1, const Footprint& footprint);
  explicit QuickReject(const HullPart& part);

 private:
  void set_plane(int k, const Vec3& at, const Vec3& up);
  void set_turning_tube(const ConvexGroup& group, const Motion& motion, double t0, double t1);
  void set_tube(const Pose& from, const Vec3& way, double radius, double size);
};

}  // namespace riffler::sweep
