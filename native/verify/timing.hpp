// How long moves take.
#pragma once

#include "riffler/nc/program.hpp"

namespace riffler::verify {

/// deg/min at which an axis is taken to turn while the tip stands still.
inline constexpr double kRotaryRate = 3600;

/// s for the move from `from` to row `row` of the program: the tip's way at its feed, rapids at `rapid_feed` (mm/min);
/// where the tip stands still, the axis' angle at kRotaryRate. Acceleration and tool changes are left out.
double seconds_of(const Pose& from, const nc::Program& program, std::size_t row, double rapid_feed);

}  // namespace riffler::verify
