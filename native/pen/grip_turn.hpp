// The orientation of a grip as a sample has it: axis, spin and rate.
#pragma once

#include "riffler/geom/vec.hpp"
#include "riffler/pen/sample.hpp"

namespace riffler::pen {

/// A rotation as a quaternion of unit length.
struct UnitQuaternion {
  double w = 1;
  Vec3 v{0};
};

/// The rotation whose columns are the images of x, y, z: orthonormal and right-handed.
UnitQuaternion quaternion_of(const Mat3& columns);

/// `v`, rotated.
Vec3 rotated(const UnitQuaternion& q, const Vec3& v);

/// Follows the orientations of one grip.
class GripTurn {
 public:
  /// `own`: unit vector in the grip's own frame, from the tip to the grip's end. `smooth`: s over which the rate is
  /// averaged: a grip that reports in steps would otherwise show them as speeds that no hand has.
  GripTurn(const Vec3& own, double smooth) : own_(own), smooth_(smooth) {}

  /// The next orientation has none before it.
  void begin() noexcept { turned_ = false; }
  /// Sets axis, spin and rate of the sample. The spin is the twist about the grip's own axis (swing and twist),
  /// unwrapped; where it has no meaning, half a turn from the rest orientation, it stays.
  void turn(const UnitQuaternion& q, double now, PenSample& sample) noexcept;

 private:
  Vec3 own_;
  double smooth_;
  bool turned_ = false;
  double time_ = 0, twist_ = 0;
};

}  // namespace riffler::pen
