#include "sweep/steps.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {

/// Share of the tolerance that the departure from convexity may use. Where moving a ray sideways by the tolerance moves
/// its ends by at most twice that, the surface's slope against the ray is at most 2, so a displacement d in space moves
/// an end along the ray by at most √5 d; 0.1 more is left to the search for extremes.
constexpr double kShare = 0.35;

/// Greatest height on the axis at which the tool can meet the box during the move. f(t) = (corner − tip) · axis has
/// |f″| ≤ 2 P φ + D φ², so it exceeds its ends' greater value by at most an eighth of that.
double highest_contact(const Motion& motion, const Box3& box) {
  double height = -std::numeric_limits<double>::infinity(), far = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 c{corner & 1 ? box.upper.x : box.lower.x, corner & 2 ? box.upper.y : box.lower.y,
                 corner & 4 ? box.upper.z : box.lower.z};
    for (const Pose& pose : {motion.from(), motion.to()}) {
      height = std::max(height, glm::dot(c - pose.tip, pose.axis));
      far = std::max(far, glm::length(c - pose.tip));
    }
  }
  const double way = glm::length(motion.to().tip - motion.from().tip), turn = motion.angle();
  return height + (2 * way * turn + (far + way) * turn * turn) / 8;
}

/// The piece without what lies above `height` on the axis, where a frustum can be cut without changing its lower part.
Piece below(const Piece& piece, double height) {
  const auto* f = std::get_if<Frustum>(&piece);
  if (!f || height >= f->z1) return piece;
  return Frustum{f->z0, f->r0, height, radius_at(piece, height)};
}

/// The t at which the axis is square to the rays, where rays change the face through which they enter; −1 if nowhere.
/// axis(t) = cos(φ t) a + sin(φ t) b, with b from the axis at the end.
double edge_on(const Motion& motion) {
  const double a = motion.from().axis.z, end = motion.to().axis.z, angle = motion.angle();
  if (!(a * end < 0)) return -1;
  const double b = (end - std::cos(angle) * a) / std::sin(angle);
  const double t = std::atan2(std::abs(a), a > 0 ? -b : b) / angle;
  return t > 0 && t < 1 ? t : -1;
}

void turning_steps(const Piece& piece, const Motion& motion, std::uint32_t move, const Box3& box, double tolerance,
                   const std::function<void(Step&&)>& sink) {
  const double lever = std::hypot(std::max(std::abs(bottom(piece)), std::abs(top(piece))), max_radius(piece));
  const double way = glm::length(motion.to().tip - motion.from().tip);
  const std::uint64_t n = part_count(motion.angle(), way, lever, kShare * tolerance);
  const auto part = [&](double t0, double t1) {
    const Footprint footprint(piece, {motion.at(t0), motion.at(t1)}, tolerance);
    if (footprint.overlaps(box)) sink(Step(move, footprint, TurningPiece(piece, motion, t0, t1, tolerance)));
  };
  const double turn = edge_on(motion);
  double from = 0;
  for (std::uint64_t k = 0; k < n; ++k) {
    const double to = static_cast<double>(k + 1) / static_cast<double>(n);
    if (from < turn && turn < to) part(from, turn), from = turn;
    part(from, to);
    from = to;
  }
}

}  // namespace

void Step::hit(double u, double v, const Interval& material, SweptIntervals& out) const {
  if (const auto* turning = std::get_if<TurningPiece>(&body_)) return turning->hit(u, v, material, out);
  SweptInterval interval;
  if (std::get<SweptPiece>(body_).hit(u, v, interval.near, interval.far)) out.add(interval);
}

Vec3 Step::normal(double u, double v, const SweptHit& hit, double t) const {
  if (const auto* turning = std::get_if<TurningPiece>(&body_)) return turning->normal(u, v, hit, t);
  return std::get<SweptPiece>(body_).normal(u, v, hit);
}

std::uint64_t part_count(double angle, double way, double lever, double bound) {
  const double n = std::sqrt((lever * angle + 2 * way) * angle / (2 * bound));
  // Half a radian a part at most keeps silhouettes apart however loose the tolerance.
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(std::min(std::max(n, 2 * angle), 1e12))));
}

void for_each_step(const Piece& piece, const Motion& motion, std::uint32_t move, const Box3& box, double tolerance,
                   const std::function<void(Step&&)>& sink) {
  const double height = highest_contact(motion, box);
  if (height <= bottom(piece)) return;
  const Piece low = below(piece, height);
  if (motion.angle() > 0) return turning_steps(low, motion, move, box, tolerance, sink);
  const Footprint footprint(low, {motion.from(), motion.to()}, 0);
  const Pose& from = motion.from();
  if (footprint.overlaps(box))
    sink(Step(move, footprint, SweptPiece(low, from.tip, from.axis, motion.to().tip - from.tip)));
}

}  // namespace riffler
