// Where a move needs more blocks, because the axes of a machine move linearly and the tool is to move on a line and a
// great circle.
#pragma once

#include <algorithm>
#include <vector>

#include "nc/machine/machine.hpp"

namespace riffler::nc {

/// All axes at the share t of their way from a to b.
Joints mix(const Joints& a, const Joints& b, double t);
/// Degrees that the rotary axes turn between them, all together.
double rotary_way(const Joints& a, const Joints& b);
/// The share of the move at which its axis is nearest to the pole or to its opposite.
double nearest_to_pole(const Motion& motion, const Vec3& pole);

/// Within this angle (rad) of a pole, and within half the tolerance, the free rotary axis stays where it is: the noise
/// of axes that went through single precision must not turn the table.
inline constexpr double kFreeAngle = 1e-6;
inline double free_angle(double axis_tolerance) {
  return std::min(kFreeAngle, axis_tolerance / 2);
}

/// Splits moves until axes that move linearly keep the tip within `tolerance` (mm) of the line and the axis within
/// `axis_tolerance` (rad) of the great circle, each at the same share of the move.
class Subdivider {
 public:
  Subdivider(const Machine& machine, double tolerance, double axis_tolerance)
      : machine_(machine), tolerance_(tolerance), axis_tolerance_(axis_tolerance) {}

  /// Joints at the ends of the blocks of the move from (pose a, joints ja) to (pose b, joints jb); the last is jb.
  /// `free`: the axis may go any way between its ends. Throws std::invalid_argument where the rotary axes cannot
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
