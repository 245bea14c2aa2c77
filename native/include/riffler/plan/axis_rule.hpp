// Rules for tool axes that change along the rows of an operation.
#pragma once

#include <vector>

#include "riffler/geom/vec.hpp"
#include "riffler/plan/cc_frame.hpp"

namespace riffler::plan {

/// A rule for the tool axis at each place of a row, in five axes.
struct AxisRule {
  enum class Kind {
    Lean,       ///< the part's normal at the contact, leaned by `lean` in the frame of feed and normal
    Towards,    ///< from the ball's centre towards `target`, so that the tool's upper end leans there
    Away,       ///< from `target` to the ball's centre
    LeastTilt,  ///< the free axis nearest to the set-up's; see plan/least_tilt.hpp
  } kind = Kind::Lean;
  Lean lean{};                           ///< rad
  std::vector<Vec3> target{};            ///< mm: a point, or the corners of a curve, of which the nearest point counts
  double max_tilt = 1.0471975511965976;  ///< largest angle from the set-up's axis, rad; axes beyond it are moved there
  double max_turn = 0.1;                 ///< largest change of the axis along a row, rad per mm of the ball's path
};

/// Largest `max_tilt`, rad: the tool must be able to leave along its axis to the clearance plane.
inline constexpr double kMaxTilt = 1.3962634015954636;

/// Throws std::invalid_argument naming the argument that is not finite or out of range.
void validate(const AxisRule& rule);

}  // namespace riffler::plan
