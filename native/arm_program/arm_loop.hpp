// The program's work: lists a library's arms, or opens one and exchanges readings and commands.
#pragma once

#include <string>
#include <vector>

#include "arm_program/library_arm.hpp"
#include "pen/library/arm_channel.hpp"

namespace riffler::arm_program {

/// Tells Riffler, after what the phase speaks of was written.
void set_phase(pen::ArmChannel& channel, pen::ArmChannel::Phase phase);

/// Describes each arm in the channel. `held`: keys of those that Riffler has open, which are not opened again.
void list(Library& library, const std::vector<std::string>& held, pen::ArmChannel& channel);

/// Opens the arm of that name, lets it push, and serves it until Riffler ends that, Riffler is gone, or the arm is.
/// Throws OpenError.
void serve(Library& library, const std::string& name, const std::vector<std::string>& held, pen::ArmChannel& channel);

}  // namespace riffler::arm_program
