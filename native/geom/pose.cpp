#include "riffler/geom/pose.hpp"

#include "base/functions.hpp"

namespace riffler::geom {

Motion::Motion(const Pose& from, const Pose& to) : from_(from), to_(to), angle_(0), rotation_(0), side_(0), mean_(0) {
  const Vec3 cross = glm::cross(from.axis, to.axis);
  const double sine = glm::length(cross), cosine = glm::dot(from.axis, to.axis);
  // atan2 keeps its relative accuracy at both ends, where acos and asin lose half of their digits.
  angle_ = base::atan2(sine, cosine);
  if (sine > 0) {
    const Vec3 normal = cross / sine;
    rotation_ = angle_ * normal;
    side_ = glm::cross(normal, from.axis);
  } else {
    angle_ = 0;
  }
}

Motion::Motion(const Pose& from, const Pose& to, const Vec3& about, double angle)
    : from_(from),
      to_(to),
      angle_(angle),
      rotation_(angle * about),
      side_(glm::cross(about, from.axis)),
      mean_(glm::dot(about, from.axis) * about) {}

Vec3 Motion::axis(double t) const {
  if (t == 1) return to_.axis;
  if (angle_ == 0) return from_.axis;
  if (mean_ != Vec3(0)) return mean_ + base::cos(t * angle_) * (from_.axis - mean_) + base::sin(t * angle_) * side_;
  return base::cos(t * angle_) * from_.axis + base::sin(t * angle_) * side_;
}

}  // namespace riffler::geom
