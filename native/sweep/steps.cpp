#include "sweep/steps.hpp"

#include <algorithm>
#include <cmath>

#include "geom/hypot.hpp"
#include "sweep/near_box.hpp"

namespace riffler::sweep {

namespace {

/// rad. A turning move is first split into parts of at most this angle, so that their footprints stay near the tool.
constexpr double kWidestPart = 0.25;
/// In radii. In one part the tip moves no farther than this, so that the tool does not pass a ray on both sides.
constexpr double kLongestPart = 1.5;
/// Maximum number of parts due to the tip's path alone.
constexpr double kMaxParts = 32;
/// In radii: height above the highest contact at which a piece is truncated.
constexpr double kStepMargin = 0.01;

/// Greatest height on the axis at which the piece can meet the box between two poses less than a quarter turn apart.
/// Where the axis leans out of a face of the box with normal m, o · m > 0, that component is a concave function of
/// time. The disc of radius ρ at height ζ stays beyond the face as long as tip · m + ζ o · m − ρ √(1 − (o · m)²) does.
double highest_contact(const tool::Piece& piece, const Pose& from, const Pose& to, const Box3& box) {
  double radius = max_radius(piece), slope = 0;
  if (const auto* f = std::get_if<tool::Frustum>(&piece))
    slope = (f->r1 - f->r0) / (f->z1 - f->z0), radius = f->r0 - slope * f->z0;  // at ζ = 0
  double height = top(piece);
  for (int i = 0; i < 3; ++i)
    for (const double m : {-1.0, 1.0}) {
      const double lean = std::clamp(std::min(m * from.axis[i], m * to.axis[i]), 0.0, 1.0);
      const double across = std::sqrt(1 - lean * lean), rise = lean - slope * across;
      if (!(rise > 0) || lean == 0) continue;
      const double face = m > 0 ? box.upper[i] : -box.lower[i], tip = std::min(m * from.tip[i], m * to.tip[i]);
      height = std::min(height, (face - tip + radius * across) / rise);
    }
  return height;
}

/// The parts of convex pieces, from the tip upwards, that can meet the box between two poses: everything below one
/// height.
ConvexGroup reachable(std::span<const tool::Piece> pieces, double thinnest, const Pose& from, const Pose& to,
                      const Box3& box) {
  double height = -std::numeric_limits<double>::infinity();
  for (const tool::Piece& piece : pieces)
    if (const double h = highest_contact(piece, from, to, box); h > bottom(piece)) height = std::max(height, h);
  // Slightly higher, so that no cut ends at the truncation itself.
  height += kStepMargin * (pieces.empty() ? 0 : max_radius(pieces.back()));
  ConvexGroup out;
  out.thinnest = thinnest;
  for (const tool::Piece& piece : pieces) {
    if (height <= bottom(piece)) continue;
    const auto* f = std::get_if<tool::Frustum>(&piece);
    const bool cut = f && height < f->z1;
    out.pieces[out.count++] = cut ? tool::Frustum{f->z0, f->r0, height, radius_at(piece, height)} : piece;
  }
  return out;
}

double lever_of(const ConvexGroup& group) {
  double lever = 0;
  for (const tool::Piece& p : group.all())
    lever = std::max(lever, geom::hypot(std::max(std::abs(bottom(p)), std::abs(top(p))), max_radius(p)));
  return lever;
}

/// Fraction of the tolerance by which chords may deviate from the path of a ball's centre. If the surface is no steeper
/// against the ray than 2, the error along the ray is √5 times that.
constexpr double kChordShare = 0.4;

/// The centre of a ball moves on an arc about the tip: |c″| = zc φ², so n chords deviate by at most zc φ² / (8 n²).
void ball_chords(const ConvexGroup& group, const Motion& motion, double t0, double t1, std::uint32_t move,
                 const Box3& box, double tolerance, const std::function<void(Step&&)>& sink) {
  const double centre = std::get<tool::Round>(group.pieces[0]).zc, angle = motion.angle() * (t1 - t0);
  const int n = std::max(1, static_cast<int>(std::ceil(angle * std::sqrt(centre / (8 * kChordShare * tolerance)))));
  Pose from = motion.at(t0);
  for (int k = 0; k < n; ++k) {
    const double a = t0 + (t1 - t0) * k / n, b = k + 1 == n ? t1 : t0 + (t1 - t0) * (k + 1) / n;
    const Pose to = motion.at(b);
    const Footprint footprint(group.all(), {from, to}, 0);
    const Vec3 way = (to.tip - from.tip) + centre * (to.axis - from.axis);
    if (footprint.overlaps(box))
      sink({move, &motion, footprint, StraightPart{group, StraightBody(group, from, way, a, b)}});
    from = to;
  }
}

void turning_parts(const ConvexGroup& whole, const Motion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink) {
  const Interval times = near_box(1.01 * lever_of(whole), motion, box);
  if (times.empty()) return;
  double radius = 0;
  for (const tool::Piece& p : whole.all()) radius = std::max(radius, max_radius(p));
  const double length = times.length(), turn = motion.angle() * length;
  const double radii = length * glm::length(motion.to().tip - motion.from().tip) / (kLongestPart * radius);
  const int n = static_cast<int>(std::ceil(std::max({turn / kWidestPart, std::min(radii, kMaxParts), 1.0})));
  const double angle = turn / n;
  Pose from = times.near > 0 ? motion.at(times.near) : motion.from();
  for (int k = 0; k < n; ++k) {
    const double t0 = times.near + length * k / n, t1 = k + 1 == n ? times.far : times.near + length * (k + 1) / n;
    const Pose to = motion.at(t1);
    ConvexGroup group = reachable(whole.all(), whole.thinnest, from, to, box);
    if (group.count > 0 && whole_ball(group.pieces[0])) {
      ConvexGroup ball = group;
      ball.count = 1;
      ball_chords(ball, motion, t0, t1, move, box, tolerance, sink);
      std::shift_left(group.pieces.begin(), group.pieces.end(), 1), --group.count;
    }
    if (group.count > 0) {
      const Footprint footprint(group.all(), {from, to}, lever_of(group) * angle * angle / 8);
      if (footprint.overlaps(box)) sink({move, &motion, footprint, TurningPart{group, t0, t1}});
    }
    from = to;
  }
}

}  // namespace

TileBlock tiles_under(const dexel::Grid& grid, const Footprint& footprint) {
  const auto [u0, u1] = dexel::ray_indices(footprint.rows(), grid.box().lower.x, grid.pitch(), grid.nu());
  const auto [v0, v1] = dexel::ray_indices(footprint.columns(), grid.box().lower.y, grid.pitch(), grid.nv());
  if (u0 > u1 || v0 > v1) return {0, -1, 0, -1};
  return {u0 / dexel::kTileSide, u1 / dexel::kTileSide, v0 / dexel::kTileSide, v1 / dexel::kTileSide};
}

void for_each_step(std::span<const ConvexGroup> cutter, const Motion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink) {
  for (const ConvexGroup& whole : cutter) {
    if (motion.angle() > 0) {
      turning_parts(whole, motion, move, box, tolerance, sink);
      continue;
    }
    Pose from = motion.from(), to = motion.to();
    const ConvexGroup group = reachable(whole.all(), whole.thinnest, from, to, box);
    if (group.count == 0) continue;
    const Interval times = near_box(1.01 * lever_of(group), motion, box);
    if (times.empty()) continue;
    if (times.near > 0) from = motion.at(times.near);
    if (times.far < 1) to = motion.at(times.far);
    const Footprint footprint(group.all(), {from, to}, 0);
    if (footprint.overlaps(box))
      sink({move, &motion, footprint, StraightPart{group, StraightBody(group, from, to.tip - from.tip, 0, 1)}});
  }
}

}  // namespace riffler::sweep
