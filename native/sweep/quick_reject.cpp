#include "sweep/quick_reject.hpp"

#include <algorithm>
#include <cmath>

namespace riffler::sweep {

namespace {
/// Relative to the size: far more than the rounding error of a kernel's hits and than the gaps between the pieces of a
/// group, and far too little to matter.
constexpr double kMargin = 1e-8;

double widest_radius(const PieceShape& s) {
  return s.round && s.zc > s.z0 && s.zc < s.z1 ? std::max(s.e, 0.0) + s.r : std::max(s.r0, s.r1);
}
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
    alone = b.count == 1;
    kind = alone || (b.tilt == 0 && b.oz > 0 && lean == 0) ? Kind::Ball : Kind::BallAndFlank;
    for (int i = 0; i < 3; ++i) centre.from[i] = start[i], centre.way[i] = along[i], centre.axis[i] = up[i];
    centre.per_square = b.way > 0 ? 1 / (b.way * b.way) : 0;
    centre.square = first.r * first.r + kMargin * first.r * (first.r + b.way);
  } else if (b.tilt > 0) {  // an upright tool's end is as low as the footprint: no planes
    if (b.oz > 0) kind = Kind::Planes;
    set_plane(0, start, up), set_plane(1, start + along, up);
    slack = kMargin * (size + b.way), per_depth = kMargin;
  }
  double widest = 0;
  for (std::size_t k = 0; k < b.count; ++k) widest = std::max(widest, widest_radius(b.pieces[k]));
  set_tube({start, up}, along, widest, size + b.way);
}

QuickReject::QuickReject(const ConvexGroup& group, const Motion& motion, double t0, double t1,
                         const Footprint& footprint) {
  const Pose poses[2] = {motion.at(t0), motion.at(t1)};
  set_turning_tube(group, motion, t0, t1);
  if (poses[0].axis.z > 0 && poses[1].axis.z > 0) kind = Kind::Planes;
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

/// A polytope's faces are as cheap as any test before them.
QuickReject::QuickReject(const HullPart&) : lean(0), slack(0), per_depth(0) {}

/// The tool's line without ends has the axis of the middle of the step; elsewhere each of its points is off that line
/// by at most the angle between times its distance from the tip.
void QuickReject::set_turning_tube(const ConvexGroup& group, const Motion& motion, double t0, double t1) {
  double widest = 0, size = 0;
  for (const tool::Piece& piece : group.all()) {
    widest = std::max(widest, max_radius(piece));
    size = std::max({size, std::abs(bottom(piece)), std::abs(top(piece))});
  }
  const double half = motion.angle() * (t1 - t0) / 2;
  const Vec3 way = motion.tip(t1) - motion.tip(t0);
  set_tube({motion.tip(t0), motion.axis((t0 + t1) / 2)}, way, widest + half * (size + widest), size + glm::length(way));
}

void QuickReject::set_tube(const Pose& from, const Vec3& way, double radius, double size) {
  // Along the axis, rays leave the tube nowhere.
  constexpr double kParallel = 0.9;
  has_tube = std::abs(from.axis.z) < kParallel;
  if (!has_tube) return;
  const Vec3 across = way - glm::dot(way, from.axis) * from.axis;
  for (int i = 0; i < 3; ++i) tube.from[i] = from.tip[i], tube.way[i] = across[i], tube.axis[i] = from.axis[i];
  const double square = glm::dot(across, across);
  tube.per_square = square > 0 ? 1 / square : 0;
  tube.square = radius * radius + kMargin * (radius + size) * (radius + size);
  tube.endless = true;
}

void QuickReject::set_plane(int k, const Vec3& at, const Vec3& up) {
  has_planes = true;
  for (int i = 0; i < 3; ++i) foot[k][i] = at[i], normal[k][i] = up[i];
}

}  // namespace riffler::sweep
