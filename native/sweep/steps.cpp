#include "sweep/steps.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {

/// Share of the tolerance that the displacement in space may use. Where moving a ray sideways by the tolerance moves
/// its ends by at most twice that, the surface's slope against the ray is at most 2, so a displacement d in space moves
/// an end along the ray by at most √5 d: 0.44 would do.
constexpr double kShare = 0.4;

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

struct Pivot {
  double height, lever;
};

/// The point of the axis about which the piece is turned from step to step, and how far its points are from there. A
/// whole ball does not change when it is turned about its centre, a torus moves as its disc does.
Pivot pivot_of(const Piece& piece) {
  if (const auto* r = std::get_if<Round>(&piece)) {
    const bool whole = r->z0 <= r->zc - r->r && r->z1 >= r->zc + r->r;
    if (whole && r->e >= 0) return {r->zc, r->e};
  }
  const double half = (top(piece) - bottom(piece)) / 2;
  return {bottom(piece) + half, std::hypot(half, max_radius(piece))};
}

bool touches(const SweptPiece& body, const Box3& box) {
  return body.rows().near <= box.upper.x && body.rows().far >= box.lower.x && body.columns().near <= box.upper.y &&
         body.columns().far >= box.lower.y && body.height().near <= box.upper.z && body.height().far >= box.lower.z;
}

}  // namespace

std::uint64_t step_count(double angle, double lever, double pivot, double bound) {
  if (angle == 0) return 1;
  // The positive root of bound · N² − (lever φ / 2) N − |pivot| φ² / 8 = 0.
  const double a = lever * angle / 2, b = std::abs(pivot) * angle * angle / 8;
  const double n = (a + std::sqrt(a * a + 4 * bound * b)) / (2 * bound);
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(std::ceil(std::min(n, 1e15))));
}

void for_each_step(const Piece& piece, const Motion& motion, std::uint32_t move, const Box3& box, double tolerance,
                   const std::function<void(const Step&)>& sink) {
  const double height = highest_contact(motion, box);
  if (height <= bottom(piece)) return;
  const Piece low = below(piece, height);
  if (motion.angle() == 0) {
    const Step step{move, 0.5,
                    SweptPiece(low, motion.from().tip, motion.from().axis, motion.to().tip - motion.from().tip)};
    if (touches(step.body, box)) sink(step);
    return;
  }
  const Pivot pivot = pivot_of(low);
  const std::uint64_t n = step_count(motion.angle(), pivot.lever, pivot.height, kShare * tolerance);
  const auto at = [&](double t) { return motion.tip(t) + pivot.height * motion.axis(t); };
  Vec3 from = at(0);
  for (std::uint64_t k = 0; k < n; ++k) {
    const double t = (static_cast<double>(k) + 0.5) / static_cast<double>(n);
    const Vec3 axis = motion.axis(t), to = at(static_cast<double>(k + 1) / static_cast<double>(n));
    const Step step{move, t, SweptPiece(low, from - pivot.height * axis, axis, to - from)};
    if (touches(step.body, box)) sink(step);
    from = to;
  }
}

}  // namespace riffler
