// Whether a machine can run a program: its limits and its reach.
#pragma once

#include <optional>
#include <string>

#include "geom/vec.hpp"
#include "nc/options.hpp"
#include "nc/program.hpp"
#include "verify/report.hpp"

namespace riffler::verify {

/// What a program is to run on: a name of machines(), or the path of a description, and its options.
struct MachineChoice {
  std::string name;
  nc::Options options;
  /// From the verified coordinates to those that the machine's program is in: p → turn p + shift.
  Mat3 turn{1};
  Vec3 shift{0};
};

/// The first row that cannot be written for the machine, within the limits of its axes, or nothing. `program` begins
/// with row `first_row`. std::invalid_argument for a machine or an option that is not known.
std::optional<Finding> machine_fault(const nc::Program& program, std::int64_t first_row, const MachineChoice& machine);

}  // namespace riffler::verify
