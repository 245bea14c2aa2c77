// A tool lifted along its own axis until it is free (4.3.4).
#pragma once

#include "riffler/collide/collider.hpp"

namespace riffler::plan {

struct LiftRule {
  /// Wanted over part and fixtures, mm; negative allows that depth, for cuts that are to touch.
  double clearance = 0;
  double tolerance = 1e-9;    ///< of the clearance, mm: what rounding leaves in doubt anyway
  double max_lift = 1e3;      ///< mm
  int max_evaluations = 200;  ///< of the clearance
};

/// Throws std::invalid_argument naming what is not finite, or not positive where it must be.
void validate(const LiftRule& rule);

/// What a lift came to.
struct Lift {
  bool free = false;
  bool swallowed = false;  ///< nothing touches it at `height`, since it is wholly within the part's material; not free
  double height = 0;     ///< mm along the axis; where it is not free: as far as everything below is known to be blocked
  double before = 0;     ///< clearance at the pose itself, mm
  double clearance = 0;  ///< where it ended, mm
  collide::Touch touch = collide::Touch::Cutter;  ///< what was in the way last, or is nearest where nothing was
  Vec3 point{0};                                  ///< of part or fixture, there
  int evaluations = 0;
};

/// The least lift from `pose` at which the clearance is `rule.clearance`, from below: at every lower height the
/// clearance is less, and at `height` it is at least rule.clearance − rule.tolerance.
///
/// The clearance at a height names a deepest point. That point alone blocks every height until it is out of the tool,
/// which is known in closed form (plan/point_lift.hpp), so the lift goes there at once: never past a free height, and,
/// since the clearance is the least of such functions of fixed points and touches the deepest point's, with Newton's
/// quadratic convergence where that point moves smoothly. Where an upright wall stays equally deep for long, a point
/// that is deepest further up and has been in the tool since here allows the whole way between; such looks ahead
/// double, or go where steps that shrink by a steady ratio (an edge of the tool is the last to leave) are to end. A
/// lift that would end within the part's material has no free height. `pose` must have a unit axis.
Lift lift(const collide::Collider& collider, const collide::Assembly& assembly, const Pose& pose, const LiftRule& rule);

}  // namespace riffler::plan
