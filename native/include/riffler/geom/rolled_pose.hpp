// Poses of a tool that is no body of revolution, and the motion between two of them.
#pragma once

#include "riffler/geom/pose.hpp"
#include "riffler/geom/vec.hpp"

namespace riffler::geom {

/// Position and orientation of a tool: its tip (mm), its unit axis from the tip to the handle, and the unit vector of
/// its cutting direction, at a right angle to the axis.
struct RolledPose {
  Vec3 tip{0, 0, 0};
  Vec3 axis{0, 0, 1};
  Vec3 forward{1, 0, 0};
};

/// Rotation from the tool's frame: x forward, y across, z along the axis. Small deviations of the two vectors from unit
/// length and from a right angle are corrected; the axis keeps its direction.
Mat3 frame_of(const RolledPose& pose);

/// The shortest rotation from one frame to another.
struct Turn {
  Vec3 axis{0, 0, 1};  ///< unit vector
  double angle = 0;    ///< rad, 0 … π; as accurate for 1e-12 as the frames are
};
Turn turn_between(const Mat3& from, const Mat3& to);
/// Whether two poses are a half turn apart, so that the shortest rotation between them is not defined.
bool half_turn(const RolledPose& from, const RolledPose& to);

/// The motion between two rolled poses: the tip moves on a straight line, the frame by the shortest rotation at
/// constant rate, both as functions of one t in [0, 1].
class RolledMotion : public Motion {
 public:
  /// The poses must not be a half turn apart.
  RolledMotion(const RolledPose& from, const RolledPose& to);

  /// The frame at time t in [0, 1]; the exact frames of the two poses at 0 and 1.
  Mat3 frame(double t) const;

 private:
  RolledMotion(const RolledPose& from, const RolledPose& to, const Mat3& start, const Mat3& end, const Turn& turn);

  Mat3 start_, end_;
  Turn turn_;
};

}  // namespace riffler::geom

namespace riffler {
using geom::RolledMotion;
using geom::RolledPose;
}  // namespace riffler
