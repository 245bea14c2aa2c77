// Which of a machine's rotary positions holds a tool axis.
#pragma once

#include "nc/machine/machine.hpp"

namespace riffler::nc {

/// The rotary axes that hold `axis` (unit, part coordinates) and are reached from `near` by the shortest way, of those
/// within the machine's limits where there are any; X Y Z without meaning. `free`: Machine::joints.
/// std::invalid_argument where the machine cannot hold it.
Joints joints_holding(const Machine& machine, const Vec3& axis, const Joints& near, double free);

/// Whether an angle (deg) is a whole number of turns, but for what printed angles are off.
bool is_whole_turn(double degrees);

}  // namespace riffler::nc
