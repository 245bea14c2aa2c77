#include "reference/swept_distance.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

#include "geom/math.hpp"

namespace riffler::reference {

/// The point's motion in the tool's frame over an interval of half-width `half`.
struct SweptDistance::Approach {
  Vec3 velocity, radial, axis;  // at its middle; radial: unit vector from the axis to the point
  double half, speed, acceleration;

  /// Lower bound of the distance from its value in the middle alone.
  double by_speed(double distance) const { return distance - speed * half; }
  /// Lower bound from the slope and the free ball; never better than the tangent.
  double by_slope(const Nearest& at) const {
    const double bend = at.free_radius - at.distance;
    if (!at.normal || !(bend > 0)) return by_speed(at.distance);
    const double slope = std::abs(glm::dot(at.normal->x * radial + at.normal->y * axis, velocity));
    return at.distance - slope * half - (acceleration + speed * speed / bend) / 2 * half * half;
  }
};

/// Lower bound outside a cutter that is not convex, slice by slice. A bound below 0 is valid if only one slice can be
/// met, because then the point leaves the cutter where it leaves that slice.
double SweptDistance::by_slices(const Approach& approach, const Place& place, double best) const {
  double lower = std::numeric_limits<double>::infinity(), others = lower;
  for (std::size_t k = 0; k < cutter_->slices(); ++k) {
    const Nearest at = cutter_->nearest_in_slice(k, place.rho, place.z);
    const double far = approach.by_speed(at.distance);
    if (far >= std::max(best, 0.0)) {
      others = std::min(others, far);
      continue;
    }
    const double bound = std::max(far, approach.by_slope(at));
    others = std::min(others, std::max(lower, bound));
    lower = std::min(lower, bound);
  }
  return lower >= 0 || others > -lower ? lower : -std::numeric_limits<double>::infinity();
}

/// `from_start`: the point relative to the tip at t = 0. Subtracting first keeps full accuracy far from the origin.
SweptDistance::Place SweptDistance::place(const Vec3& from_start, double t) const {
  const Vec3 w = from_start - t * (motion_.to().tip - motion_.from().tip), axis = motion_.axis(t);
  const double z = glm::dot(w, axis);
  const Vec3 radial = w - z * axis;
  return {w, axis, radial, glm::length(radial), z};
}

/// Any bound above `above` is good enough.
SweptDistance::Node SweptDistance::node(const Vec3& from_start, double t, double half, double above,
                                        double& best) const {
  const Place here = place(from_start, t);
  const Nearest at = cutter_->nearest(here.rho, here.z);
  best = std::min(best, at.distance);

  const Vec3 way = motion_.to().tip - motion_.from().tip, turn = motion_.rotation();
  const Vec3 turning = glm::cross(turn, here.from_tip), bend = glm::cross(turn, way), velocity = way + turning;
  const double speed = std::max(glm::length(velocity - half * bend), glm::length(velocity + half * bend));
  double lower = at.distance - speed * half;
  if (lower >= best || lower > above) return {t, half, lower};  // enough to leave it out
  const Approach approach{
      velocity,  here.rho > 0 ? here.radial / here.rho : geom::any_perpendicular(here.axis),
      here.axis, half,
      speed,     2 * glm::length(bend) + glm::length(turn) * (glm::length(turning) + half * glm::length(bend))};
  lower = std::max(lower, approach.by_slope(cutter_->with_free_radius(here.rho, here.z, at)));
  if (cutter_->slices() > 0 && at.distance > 0) lower = std::max(lower, by_slices(approach, here, best));
  return {t, half, lower};
}

/// The bracket of a straight move; none inside a cutter that is not convex, and none for hollow arcs.
std::optional<Bracket> SweptDistance::by_tangents(const Vec3& from_start, double gap, double below,
                                                  double above) const {
  if (motion_.angle() > 0 || !(cutter_->convex() || cutter_->slices_convex())) return {};
  const Vec3 way = motion_.to().tip - motion_.from().tip;
  const auto least = [&](const auto& nearest, double most) {
    const auto tangent = [&](double t) {
      const Place here = place(from_start, t);
      const Nearest at = nearest(here.rho, here.z);
      // On the axis any direction away from it will do.
      const Vec3 radial = here.rho > 0 ? here.radial / here.rho : geom::any_perpendicular(here.axis);
      return Tangent{t, at.distance, -glm::dot(at.support.x * radial + at.support.y * here.axis, way)};
    };
    return least_of_convex(tangent, gap, below, most);
  };
  if (cutter_->convex()) return least([&](double rho, double z) { return cutter_->nearest(rho, z); }, above);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Bracket all{kInfinity, kInfinity, 0};
  for (std::size_t k = 0; k < cutter_->slices(); ++k) {
    const auto in_slice = [&](double rho, double z) { return cutter_->nearest_in_slice(k, rho, z); };
    const Bracket found = least(in_slice, std::min(above, all.upper));
    all = {std::min(all.lower, found.lower), std::min(all.upper, found.upper), all.poses + found.poses};
    if (found.upper >= 0) continue;
    // No point is deeper in a slice than in the cutter.
    return found.upper < below ? std::optional(Bracket{-kInfinity, found.upper, all.poses}) : std::nullopt;
  }
  return all;
}

Bracket SweptDistance::bracket(const Vec3& p, double gap, double below, double above) const {
  const Vec3 from_start = p - motion_.from().tip;
  if (const auto found = by_tangents(from_start, gap, below, above)) return *found;
  double best = std::numeric_limits<double>::infinity();
  node(from_start, 0, 0, above, best);
  node(from_start, 1, 0, above, best);
  int poses = 3;
  std::priority_queue<Node> open;
  open.push(node(from_start, 0.5, 0.5, above, best));
  for (;;) {
    const Node least = open.top();
    const double lower = std::min(least.lower, best);
    if (best - lower <= gap || lower > above || best < below || least.half < 1e-16) return {lower, best, poses};
    open.pop();
    for (const double side : {-0.5, 0.5})
      open.push(node(from_start, least.t + side * least.half, least.half / 2, above, best));
    poses += 2;
  }
}

/// No point of the cutter moves faster than the tip's speed plus the rotation of the farthest point; for nearby points
/// the rotation counts less.
double SweptDistance::lower_bound(const Vec3& p) const {
  const Place middle = place(p - motion_.from().tip, 0.5);
  const double way = glm::length(motion_.to().tip - motion_.from().tip);
  const double arm = std::min(cutter_->reach(), glm::length(middle.from_tip) + way / 2);
  return cutter_->distance(middle.rho, middle.z) - (way + motion_.angle() * arm) / 2;
}

}  // namespace riffler::reference
