#include "sweep/hull_steps.hpp"

#include <algorithm>
#include <cmath>

#include "sweep/near_box.hpp"

namespace riffler::sweep {

namespace {

/// rad. Wider parts are divided, so that their footprints stay near the tool.
constexpr double kWidestPart = 0.25;
/// Share of the tolerance. If the surface is no steeper against the ray than 2, the error along the ray is √5 times
/// that.
constexpr double kErrorShare = 0.4;

/// A vector without its share along the axis of the motion's turn; unchanged if there is none.
Vec3 across_turn(const RolledMotion& motion, const Vec3& v) {
  if (!(motion.angle() > 0)) return v;
  const Vec3 axis = motion.rotation() / motion.angle();
  return v - glm::dot(axis, v) * axis;
}

/// The largest distance of a corner from the line through the tip about which the body turns.
double reach_across(const tool::Hull& hull, const RolledMotion& motion) {
  if (!(motion.angle() > 0)) return hull.reach;
  const Mat3 frame = motion.frame(0);
  double reach = 0;
  for (const Vec3& p : hull.vertices) reach = std::max(reach, glm::length(across_turn(motion, frame * p)));
  return reach;
}

/// f = n(t) · (p − tip(t)): |f″| ≤ φ² r + 2 φ |V|, where V is the tip's displacement and r the distance p − tip(t),
/// both across the axis of the turn: r ≤ reach + |V| for a p that the body sweeps. Linear interpolation errs by at most
/// an eighth.
double interpolation_error(double reach, double angle, double way) {
  return (angle * angle * (reach + way) + 2 * angle * way) / 8;
}

void add_corners(base::BlockVector<Vec3>& out, const tool::Hull& hull, const RolledMotion& motion, double t) {
  const Mat3 frame = motion.frame(t);
  const Vec3 tip = motion.tip(t);
  for (const Vec3& p : hull.vertices) out.push_back(tip + frame * p);
}

void hull_parts(const tool::Hull& hull, const RolledMotion& motion, std::uint32_t move, const Box3& box,
                double tolerance, const std::function<void(Step&&)>& sink) {
  const Interval times = near_box(1.01 * hull.reach, motion, box);
  if (times.empty()) return;
  const double length = times.length(), angle = motion.angle() * length;
  const double way = glm::length(motion.to().tip - motion.from().tip) * length;
  const double reach = reach_across(hull, motion);
  const double error =
      interpolation_error(reach, angle, length * glm::length(across_turn(motion, motion.to().tip - motion.from().tip)));
  const int n =
      static_cast<int>(std::ceil(std::max({1.0, angle / kWidestPart, std::sqrt(error / (kErrorShare * tolerance))})));
  thread_local base::BlockVector<Vec3> corners;
  for (int k = 0; k < n; ++k) {
    const double t0 = k == 0 ? times.near : times.near + length * k / n;
    const double t1 = k + 1 == n ? times.far : times.near + length * (k + 1) / n;
    corners.clear();
    add_corners(corners, hull, motion, t0), add_corners(corners, hull, motion, t1);
    const double off = error / (static_cast<double>(n) * n);
    // What the body leaves the hull of its two poses by, and rounding of the corners.
    const Footprint footprint(corners, 2 * off + 1e-12 * (hull.reach + way));
    if (footprint.overlaps(box))
      sink({move, &motion, footprint, HullPart{&hull, &motion, t0, t1, off, reach, tolerance}});
  }
}

}  // namespace

RolledPose to_local(Axis axis, const RolledPose& p) {
  return {to_local(axis, p.tip) + 0.0, to_local(axis, p.axis) + 0.0, to_local(axis, p.forward) + 0.0};
}

void for_each_step(std::span<const tool::Hull> hulls, const RolledMotion& motion, std::uint32_t move, const Box3& box,
                   double tolerance, const std::function<void(Step&&)>& sink) {
  for (const tool::Hull& hull : hulls) hull_parts(hull, motion, move, box, tolerance, sink);
}

}  // namespace riffler::sweep
