// Selects the rotary position of a machine that holds a tool axis.
#pragma once

#include "nc/machine/machine.hpp"

namespace riffler::nc {

/// The rotary axes that hold `axis` (unit, part coordinates) with the shortest path from `near`, within the machine's
/// limits if possible; X Y Z have no meaning. `free`: see Machine::joints. Throws std::invalid_argument if the machine
/// cannot hold the axis.
Joints joints_holding(const Machine& machine, const Vec3& axis, const Joints& near, double free);

/// Whether an angle (deg) is a whole number of turns, up to the rounding of printed angles.
bool is_whole_turn(double degrees);

}  // namespace riffler::nc
