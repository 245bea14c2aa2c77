// From tool poses to the positions of a machine's axes: which of the two rotary branches, how many turns, and where a
// move needs more blocks because rotary axes do not move along great circles.
#pragma once

#include <vector>

#include "nc/machine.hpp"
#include "nc/program.hpp"

namespace riffler {

/// Within this angle (rad) of a pole the free rotary axis stays where it is: the noise of axes that went through single
/// precision must not turn the table.
inline constexpr double kFreeAngle = 1e-6;

/// One row of joints per row of the program: of all continuous choices of branches the one with the shortest rotary
/// path over the whole program (Viterbi's dynamic programme over the branches). The branch may change in rapids and
/// where the move passes the pole within axis_tolerance / 4, nowhere else: in between the rotary axes can follow the
/// great circle on one branch only. Before the first row that is away from the pole, the free axis stands where that
/// row has it. Throws std::invalid_argument naming the row that the machine cannot hold, and a feed move between
/// opposite axes.
std::vector<Joints> choose_joints(const Program& program, const Machine& machine, double axis_tolerance);

/// Splits moves until axes that move linearly keep the tip within `tolerance` (mm) of the line and, in feed moves, the
/// axis within `axis_tolerance` (rad) of the great circle, each at the same share of the move.
class Subdivider {
 public:
  Subdivider(const Machine& machine, double tolerance, double axis_tolerance)
      : machine_(machine), tolerance_(tolerance), axis_tolerance_(axis_tolerance) {}

  /// Joints at the ends of the blocks of the move from (pose a, joints ja) to (pose b, joints jb); the last is jb.
  const std::vector<Joints>& split(const Pose& a, const Joints& ja, const Pose& b, const Joints& jb, bool rapid);

 private:
  struct Part;
  bool fits(const Motion& motion, const Part& part, bool rapid) const;
  Joints between(const Motion& motion, const Part& part) const;

  const Machine& machine_;
  double tolerance_, axis_tolerance_;
  std::vector<Joints> out_;
};

}  // namespace riffler
