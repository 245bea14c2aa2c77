// Tool poses and the motion between two of them.
#pragma once

#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// Position and orientation of a tool: its tip (mm) and its unit axis, from the tip towards the spindle.
struct Pose {
  Vec3 tip{0, 0, 0};
  Vec3 axis{0, 0, 1};
};

/// The motion between two poses: the tip moves on a straight line and the axis on a great circle at constant rate, both
/// as functions of one t in [0, 1] (methods: "Conventions"). Accurate for any angle from 0 up to, but not including, π.
class Motion {
 public:
  /// Axes must be unit vectors and not exactly opposite.
  Motion(const Pose& from, const Pose& to);

  const Pose& from() const { return from_; }
  const Pose& to() const { return to_; }
  /// Axis, tip and pose at time t in [0, 1].
  Vec3 axis(double t) const;
  Vec3 tip(double t) const { return from_.tip + t * (to_.tip - from_.tip); }
  Pose at(double t) const { return {tip(t), axis(t)}; }
  /// Angle between the two axes, rad. Its relative accuracy is the same for 1e-12 as for 3.
  double angle() const { return angle_; }
  /// Rotation vector of the whole motion, rad: the great circle's unit normal times the angle; zero without rotation.
  const Vec3& rotation() const { return rotation_; }
  /// Velocity of the tool's material point that is at `p` at time t, in mm per unit of t.
  Vec3 velocity(const Vec3& p, double t) const { return (to_.tip - from_.tip) + glm::cross(rotation_, p - tip(t)); }

 protected:
  /// Any rotation by `angle` about the unit vector `about` that takes one axis to the other, for tools that roll too.
  Motion(const Pose& from, const Pose& to, const Vec3& about, double angle);

 private:
  Pose from_, to_;
  double angle_;
  Vec3 rotation_, side_;  // side_: unit vector in the plane of the great circle, normal to from_.axis
  Vec3 mean_;             // centre of the circle on which the axis turns: zero for a great circle
};

/// The point at u in [0, 1] on the great circle from unit vector `a` to unit vector `b`. They must not be opposite.
inline Vec3 slerp(const Vec3& a, const Vec3& b, double u) {
  return Motion({Vec3(0), a}, {Vec3(0), b}).axis(u);
}

}  // namespace riffler::geom

namespace riffler {
using geom::Motion;
using geom::Pose;
}  // namespace riffler
