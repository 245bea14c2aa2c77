#include "riffler/geom/rolled_pose.hpp"

#include <algorithm>
#include <cmath>

#include "base/functions.hpp"
#include "geom/math.hpp"

namespace riffler::geom {

namespace {

/// (w, x, y, z) of a rotation matrix, by the largest of the four: none of the others loses digits.
void quaternion(const Mat3& r, double& w, Vec3& v) {
  const double trace = r[0][0] + r[1][1] + r[2][2];
  if (trace > 0) {
    const double s = 2 * std::sqrt(1 + trace);
    w = s / 4, v = Vec3(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]) / s;
    return;
  }
  int i = r[1][1] > r[0][0] ? 1 : 0;
  if (r[2][2] > r[i][i]) i = 2;
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const double s = 2 * std::sqrt(std::max(0.0, 1 + r[i][i] - r[j][j] - r[k][k]));
  v[i] = s / 4, v[j] = (r[i][j] + r[j][i]) / s, v[k] = (r[i][k] + r[k][i]) / s;
  w = (r[j][k] - r[k][j]) / s;
}

/// Half the cosine below which two frames count as a half turn apart: its axis is then a matter of rounding.
constexpr double kHalfTurn = 1e-9;

}  // namespace

Mat3 frame_of(const RolledPose& pose) {
  const Vec3 z = glm::normalize(pose.axis), x = glm::normalize(pose.forward - glm::dot(pose.forward, z) * z);
  return {x, glm::cross(z, x), z};
}

Turn turn_between(const Mat3& from, const Mat3& to) {
  if (from == to) return {};
  double w;
  Vec3 v;
  quaternion(to * glm::transpose(from), w, v);
  if (w < 0) w = -w, v = -v;
  const double length = glm::length(v);
  if (!(length > 0)) return {};
  return {v / length, 2 * base::atan2(length, w)};
}

bool half_turn(const RolledPose& from, const RolledPose& to) {
  return kPi - turn_between(frame_of(from), frame_of(to)).angle < kHalfTurn;
}

RolledMotion::RolledMotion(const RolledPose& from, const RolledPose& to)
    : RolledMotion(from, to, frame_of(from), frame_of(to), turn_between(frame_of(from), frame_of(to))) {}

RolledMotion::RolledMotion(const RolledPose& from, const RolledPose& to, const Mat3& start, const Mat3& end,
                           const Turn& turn)
    : Motion({from.tip, start[2]}, {to.tip, end[2]}, turn.axis, turn.angle), start_(start), end_(end), turn_(turn) {}

Mat3 RolledMotion::frame(double t) const {
  if (t == 0 || turn_.angle == 0) return start_;
  if (t == 1) return end_;
  Mat3 out;
  for (int i = 0; i < 3; ++i) out[i] = rotate_about(start_[i], turn_.axis, t * turn_.angle);
  return out;
}

}  // namespace riffler::geom
