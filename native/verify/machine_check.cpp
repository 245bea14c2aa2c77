#include "verify/machine_check.hpp"

#include "nc/write/row_check.hpp"
#include "riffler/nc/edit.hpp"

namespace riffler::verify {

std::optional<Finding> machine_fault(const nc::Program& program, std::int64_t first_row, const MachineChoice& machine) {
  nc::WriteOptions how;
  how.post = machine.name, how.options = machine.options;
  const nc::RowCheck check(how);
  const bool moved = machine.turn != Mat3(1) || machine.shift != Vec3(0);
  const auto fault =
      moved ? check.first_fault(transformed(program, machine.turn, machine.shift)) : check.first_fault(program);
  if (!fault) return std::nullopt;
  // An incomplete program is not a fault of the machine.
  if (fault->name() != "poses") throw nc::RowError(*fault);
  Finding found{};
  found.kind = Kind::Machine;
  const std::size_t row = fault->row();
  found.tool = program.tool()[row];
  found.row = found.last_row = first_row + static_cast<std::int64_t>(row);
  found.line = found.last_line = program.line()[row];
  found.point = program.poses()[row].tip;
  found.message = fault->reason();
  return found;
}

}  // namespace riffler::verify
