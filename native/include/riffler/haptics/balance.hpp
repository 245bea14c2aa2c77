// A body of revolution without mass between springs and dampers: where it is after a step.
#pragma once

#include <array>

#include "riffler/collide/contact.hpp"
#include "riffler/haptics/resistance.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Backward Euler: the forces balance at the step's end, where springs have been stretched and dampers moved. Every
/// spring and damper adds a positive semidefinite matrix, so with one that holds the body the step exists, and whatever
/// the others are it never goes further than the springs pull: stiff contacts and tough materials need no short steps.
/// About the body's axis nothing turns it.
class Balance {
 public:
  /// Unit axis; dt > 0, s.
  Balance(const Vec3& axis, double dt) : axis_(axis), dt_(dt) {}

  /// Pulls towards a place that is `stretch` away: N/mm and N·mm/rad.
  void add_spring(double linear, double angular, const Twist& stretch);
  /// Against motion relative to a body that moves so; `moving` at the damper's own point.
  void add_damper(const Damper& damper, const Twist& moving = {});
  /// A wrench about the tip that falls by `stiffness` with the displacement.
  void add_contact(const Wrench& wrench, const collide::ContactStiffness& stiffness);

  /// The displacement, about the tip; nothing where nothing holds the body, or with numbers that are not finite.
  Twist solve() const;

 private:
  Vec3 axis_;
  double dt_;
  collide::ContactStiffness matrix_{};
  Wrench pull_;
};

}  // namespace riffler::haptics
