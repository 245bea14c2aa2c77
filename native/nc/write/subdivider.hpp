// Subdivides moves into blocks: the axes of a machine move linearly, but the tool must move on a line and a great
// circle.
#pragma once

#include <algorithm>
#include <vector>

#include "nc/machine/machine.hpp"

namespace riffler::nc {

/// Joints at fraction t between a and b.
Joints mix(const Joints& a, const Joints& b, double t);
/// Total rotation of the rotary axes between a and b, deg.
double rotary_way(const Joints& a, const Joints& b);
/// The fraction of the move at which its axis is nearest to the pole or its opposite.
double nearest_to_pole(const Motion& motion, const Vec3& pole);

/// Within this angle (rad) of a pole, and within half the tolerance, the free rotary axis stays where it is: noise of
/// axes stored in single precision must not turn the table.
inline constexpr double kFreeAngle = 1e-6;
inline double free_angle(double axis_tolerance) {
  return std::min(kFreeAngle, axis_tolerance / 2);
}

/// Splits moves until linearly moving axes keep the tip within `tolerance` (mm) of the line and the axis within
/// `axis_tolerance` (rad) of the great circle, at equal fractions of the move.
class Subdivider {
 public:
  Subdivider(const Machine& machine, double tolerance, double axis_tolerance)
      : machine_(machine), tolerance_(tolerance), axis_tolerance_(axis_tolerance) {}

  /// Joints at the ends of the blocks of the move from (pose a, joints ja) to (pose b, joints jb); the last is jb.
  /// `free`: the axis may take any path between its ends. Throws std::invalid_argument if the rotary axes cannot
  /// follow.
  const std::vector<Joints>& split(const Pose& a, const Joints& ja, const Pose& b, const Joints& jb, bool free);

 private:
  struct Part;
  struct Route;
  bool fits(const Motion& motion, const Part& part, bool free) const;
  int branch_of(const Pose& pose, const Joints& joints) const;
  Route route(const Motion& motion, const Joints& from, const Joints& to) const;
  Joints between(const Motion& motion, const Part& part, const Route& route) const;

  const Machine& machine_;
  double tolerance_, axis_tolerance_;
  std::vector<Joints> out_;
};

}  // namespace riffler::nc
