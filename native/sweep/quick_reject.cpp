#include "sweep/quick_reject.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::sweep {

namespace {
/// Relative to the size: far more than the rounding error of a kernel's hits and than the gaps between the pieces of a
/// group, and far too little to matter.
constexpr double kMargin = 1e-8;
}  // namespace

QuickReject::QuickReject(const StraightBody& b) {
  const SweptShape &first = b.pieces[0], &next = b.pieces[1];
  const bool ball = first.ball && (b.count == 1 || !next.round);
  double z0 = first.z0, size = 0;
  for (std::size_t k = 0; k < b.count; ++k)
    z0 = std::min(z0, b.pieces[k].z0), size = std::max({size, std::abs(b.pieces[k].z0), std::abs(b.pieces[k].z1)});
  Vec3 start, along, up;
  for (int i = 0; i < 3; ++i) {
    start[i] = b.tip[i] + (ball ? first.zc : z0) * b.axis[i], up[i] = b.axis[i];
    along[i] = b.way * (b.m1 * b.e1[i] + b.m2 * b.e2[i] + b.mo * b.axis[i]);
  }
  if (ball) {
    // In a convex group, the flank next to the ball leans downwards most.
    lean = b.count > 1 ? std::max(next.slope * next.cosine, 0.0) : 0;
    kind = b.count == 1 || (b.tilt == 0 && b.oz > 0 && lean == 0) ? Kind::Ball : Kind::BallAndFlank;
    for (int i = 0; i < 3; ++i) from[i] = start[i], way[i] = along[i], axis[i] = up[i];
    per_square = b.way > 0 ? 1 / (b.way * b.way) : 0;
    square = first.r * first.r + kMargin * first.r * (first.r + b.way);
  } else if (b.tilt > 0 && b.oz > 0) {  // an upright tool's end is as low as the footprint: no planes
    kind = Kind::Planes;
    set_plane(0, start, up), set_plane(1, start + along, up);
    slack = kMargin * (size + b.way), per_depth = kMargin;
  }
}

QuickReject::QuickReject(const ConvexGroup& group, const Motion& motion, double t0, double t1,
                         const Footprint& footprint) {
  const Pose poses[2] = {motion.at(t0), motion.at(t1)};
  if (!(poses[0].axis.z > 0 && poses[1].axis.z > 0)) return;
  kind = Kind::Planes;
  double height = std::numeric_limits<double>::infinity();
  for (const tool::Piece& piece : group.all()) height = std::min(height, bottom(piece));
  const Interval &rows = footprint.rows(), &columns = footprint.columns();
  double beside = 0;  // largest distance of a ray from a foot, across the rays
  for (int k = 0; k < 2; ++k) {
    const Vec3 p = poses[k].tip + height * poses[k].axis;
    set_plane(k, p, poses[k].axis);
    const double u = std::max(std::abs(rows.near - p.x), std::abs(rows.far - p.x));
    const double v = std::max(std::abs(columns.near - p.y), std::abs(columns.far - p.y));
    beside = std::max(beside, u + v);
  }
  const double angle = motion.angle() * (t1 - t0), moved = glm::length(poses[1].tip - poses[0].tip);
  // For f(t) = o · (p − tip) − height: |f″| ≤ φ² |p − tip| + 2 φ |V|, so between the ends of the step f exceeds the
  // greater of its end values by at most an eighth of that.
  per_depth = angle * angle / 8 + kMargin;
  slack =
      angle * moved / 4 + per_depth * (beside + std::abs(height) + std::abs(foot[1][2] - foot[0][2])) + kMargin * moved;
}

void QuickReject::set_plane(int k, const Vec3& at, const Vec3& up) {
  for (int i = 0; i < 3; ++i) foot[k][i] = at[i], normal[k][i] = up[i];
}

}  // namespace riffler::sweep
