#include "verify/machine_check.hpp"

#include "nc/edit.hpp"
#include "nc/write/writer.hpp"

namespace riffler {

std::optional<Finding> machine_fault(const Program& program, std::int64_t first_row, const MachineChoice& machine) {
  WriteOptions how;
  how.post = machine.name, how.options = machine.options;
  try {
    const bool moved = machine.turn != Mat3(1) || machine.shift != Vec3(0);
    to_nc(moved ? transformed(program, machine.turn, machine.shift) : program, how);
    return std::nullopt;
  } catch (const RowError& e) {
    Finding found{};
    found.kind = Kind::Machine;
    const std::size_t row = e.row();
    found.tool = program.tool()[row];
    found.row = found.last_row = first_row + static_cast<std::int64_t>(row);
    found.line = found.last_line = program.line()[row];
    found.point = program.poses()[row].tip;
    found.message = e.reason();
    return found;
  }
}

}  // namespace riffler
