// Lifts a tool along its own axis until it is free (4.3.4).
#pragma once

#include "riffler/collide/collider.hpp"

namespace riffler::plan {

/// Clearance, tolerance and limits of a lift.
struct LiftRule {
  /// Wanted clearance to part and fixtures, mm. Negative values allow that depth, for cuts that must touch.
  double clearance = 0;
  double tolerance = 1e-9;    ///< of the clearance, mm; the default covers rounding
  double max_lift = 1e3;      ///< mm
  int max_evaluations = 200;  ///< clearance evaluations
};

/// Throws std::invalid_argument naming the field that is not finite, or not positive where it must be.
void validate(const LiftRule& rule);

/// The result of a lift.
struct Lift {
  bool free = false;
  bool swallowed = false;  ///< at `height` the tool is entirely inside the part's material: no contact, but not free
  double height = 0;       ///< mm along the axis; if not free: every lower height is known to be blocked
  double before = 0;       ///< clearance at the original pose, mm
  double clearance = 0;    ///< clearance after the lift, mm
  collide::Touch touch = collide::Touch::Cutter;  ///< the last obstacle, or the nearest contact if there was none
  Vec3 point{0};                                  ///< the contact on part or fixture, mm
  int evaluations = 0;
};

/// Smallest lift from `pose` (unit axis) with clearance `rule.clearance`: at every lower height the clearance is
/// smaller, and at the result it is at least rule.clearance − rule.tolerance.
///
/// The clearance at a height comes with a deepest point. That point alone blocks every height until it leaves the tool,
/// and the height at which it does is known in closed form (plan/point_lift.hpp). The lift jumps there: never past a
/// free height. Since the clearance is the minimum of such functions over fixed points and touches the deepest point's,
/// this converges quadratically like Newton's method where the deepest point moves smoothly. Along a vertical wall many
/// points are equally deep; if a point that is deepest further up was inside the tool all the way from here, the lift
/// skips that range. The look-ahead doubles each time, or extrapolates steps that shrink geometrically (when an edge of
/// the tool is last to leave). A lift that would end inside the part's material has no free height.
Lift lift(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose, const LiftRule& rule);

}  // namespace riffler::plan
