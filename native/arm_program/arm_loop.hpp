// Main loop of riffler-arm: lists a library's arms, or opens one and exchanges readings and commands.
#pragma once

#include <string>
#include <vector>

#include "arm_program/library_arm.hpp"
#include "pen/library/arm_channel.hpp"

namespace riffler::arm_program {

/// Sets the phase for Riffler. Call it after writing the data that the phase announces.
void set_phase(pen::ArmChannel& channel, pen::ArmChannel::Phase phase);

/// Writes a description of each arm into the channel. `held`: keys of arms that Riffler has open; skips these.
void list(Library& library, const std::vector<std::string>& held, pen::ArmChannel& channel);

/// Opens the arm of that name, enables its force, and serves it until Riffler stops it or exits, or the arm is
/// unplugged. Throws OpenError.
void serve(Library& library, const std::string& name, const std::vector<std::string>& held, pen::ArmChannel& channel);

}  // namespace riffler::arm_program
