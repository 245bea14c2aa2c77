// Duration of moves.
#pragma once

#include "riffler/nc/program.hpp"

namespace riffler::verify {

/// deg/min: assumed rate of an axis while the tip stands still.
inline constexpr double kRotaryRate = 3600;

/// Duration (s) of the move from `from` to row `row` of the program: distance of the tip at its feed, rapids at
/// `rapid_feed` (mm/min); if the tip stands still, the rotation of the axis at kRotaryRate. Ignores acceleration and
/// tool changes.
double seconds_of(const Pose& from, const nc::Program& program, std::size_t row, double rapid_feed);

}  // namespace riffler::verify
