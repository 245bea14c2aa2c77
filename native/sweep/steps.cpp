#include "sweep/steps.hpp"

#include <algorithm>
#include <cmath>

namespace riffler {

namespace {

/// rad: a turning move is first cut into parts of at most this angle, so that their footprints stay near the tool.
constexpr double kWidestPart = 0.25;

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

void turning_parts(const ConvexGroup& whole, const Motion& motion, double height, std::uint32_t move, const Box3& box,
                   const std::function<void(Step&&)>& sink) {
  ConvexGroup group;
  double lever = 0;
  for (const Piece& piece : whole.all())
    if (bottom(piece) < height) {
      const Piece low = below(piece, height);
      group.pieces[group.count++] = low;
      lever = std::max(lever, std::hypot(std::max(std::abs(bottom(low)), std::abs(top(low))), max_radius(low)));
    }
  if (group.count == 0) return;
  const int n = static_cast<int>(std::ceil(motion.angle() / kWidestPart));
  const double angle = motion.angle() / n, slack = lever * angle * angle / 8;
  for (int k = 0; k < n; ++k) {
    const double t0 = static_cast<double>(k) / n, t1 = static_cast<double>(k + 1) / n;
    const Footprint footprint(group.all(), {motion.at(t0), motion.at(t1)}, slack);
    if (footprint.overlaps(box)) sink({move, footprint, TurningPart{group, &motion, t0, t1}});
  }
}

}  // namespace

void for_each_step(const Cutter& cutter, const Motion& motion, std::uint32_t move, const Box3& box,
                   const std::function<void(Step&&)>& sink) {
  const double height = highest_contact(motion, box);
  if (motion.angle() > 0) {
    for (const ConvexGroup& group : cutter.groups) turning_parts(group, motion, height, move, box, sink);
    return;
  }
  const Pose& from = motion.from();
  for (const Piece& piece : cutter.pieces) {
    if (height <= bottom(piece)) continue;
    const Piece low = below(piece, height);
    const Footprint footprint({&low, 1}, {from, motion.to()}, 0);
    if (footprint.overlaps(box)) sink({move, footprint, SweptPiece(low, from.tip, from.axis, motion.to().tip - from.tip)});
  }
}

}  // namespace riffler
