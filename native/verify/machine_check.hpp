// Whether a machine can run a program: its limits and its reach.
#pragma once

#include <cstdint>
#include <optional>

#include "riffler/nc/program.hpp"
#include "riffler/verify/arguments.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::verify {

/// The first row that cannot be written for the machine, within the limits of its axes, or nothing. `program` begins
/// with row `first_row`. std::invalid_argument for a machine or an option that is not known.
std::optional<Finding> machine_fault(const nc::Program& program, std::int64_t first_row, const MachineChoice& machine);

}  // namespace riffler::verify
