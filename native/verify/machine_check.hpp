// Checks whether a machine can run a program: its limits and its reach.
#pragma once

#include <cstdint>
#include <optional>

#include "riffler/nc/program.hpp"
#include "riffler/verify/arguments.hpp"
#include "riffler/verify/report.hpp"

namespace riffler::verify {

/// The first row that the machine cannot run within the limits of its axes, or no value. `program` begins with row
/// `first_row`. Throws std::invalid_argument for an unknown machine or option.
std::optional<Finding> machine_fault(const nc::Program& program, std::int64_t first_row, const MachineChoice& machine);

}  // namespace riffler::verify
