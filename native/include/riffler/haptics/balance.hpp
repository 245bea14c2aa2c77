// Equilibrium of a massless body of revolution held by springs, dampers and contacts, after one time step.
#pragma once

#include <array>
#include <span>

#include "riffler/collide/contact.hpp"
#include "riffler/haptics/resistance.hpp"
#include "riffler/haptics/wrench.hpp"

namespace riffler::haptics {

/// Backward Euler: the forces balance at the end of the step, with springs stretched and dampers moved up to then.
/// Every spring and damper adds a positive semidefinite matrix. One spring or damper that holds the body therefore
/// makes the step exist, and the step never overshoots what the springs ask for: stiff contacts and tough materials
/// need no shorter steps. No torque acts about the body's own axis.
class Balance {
 public:
  /// `axis`: unit vector; `dt` > 0, s.
  Balance(const Vec3& axis, double dt) : axis_(axis), dt_(dt) {}

  /// Pulls towards a pose that is `stretch` (mm, rad) away, with stiffness `linear` (N/mm) and `angular` (N·mm/rad).
  void add_spring(double linear, double angular, const Twist& stretch);
  /// Resists motion relative to a body with twist `moving`, given at the damper's own point.
  void add_damper(const Damper& damper, const Twist& moving = {});
  /// A contact wrench about the tip that decreases by `stiffness` per displacement.
  void add_contact(const Wrench& wrench, const collide::ContactStiffness& stiffness);

  /// Displacement of the tip and rotation over the step. Zero where nothing holds the body or an input is not finite.
  Twist solve() const;
  /// As above, for a body that makes the displacement `given` and, beyond it, only those in `freedoms` and their sums:
  /// at most five of them.
  Twist solve(std::span<const Twist> freedoms, const Twist& given = {}) const;

 private:
  Vec3 axis_;
  double dt_;
  collide::ContactStiffness matrix_{};
  Wrench pull_;
};

}  // namespace riffler::haptics
