// What verification reports of a machine: what the writer says.
#include "verify/machine_check.hpp"

#include <gtest/gtest.h>

#include "riffler/nc/write/writer.hpp"
#include "support/effort.hpp"
#include "support/random_rows.hpp"

namespace riffler::verify::machine_check_test {
namespace {

std::optional<nc::RowError> refused_by_writer(const nc::Program& program, const nc::WriteOptions& how) {
  try {
    to_nc(program, how);
    return std::nullopt;
  } catch (const nc::RowError& e) {
    return e;
  }
}

TEST(MachineCheck, ReportsExactlyTheRowsThatTheWriterRefuses) {
  const std::vector<nc::WriteOptions> machines = test::all_machines();
  test::RandomRows rows(23);
  int found = 0;
  for (int round = 0; round < test::cases(60, 8); ++round) {
    const nc::Program program = rows.program();
    for (const nc::WriteOptions& how : machines) {
      const auto refused = refused_by_writer(program, how);
      const auto check = [&] { return machine_fault(program, 1000, {how.post, how.options}); };
      if (refused && refused->name() == "feed") {
        EXPECT_THROW(check(), nc::RowError) << "what the program lacks is not a fault of the machine";
        continue;
      }
      const std::optional<Finding> fault = check();
      ASSERT_EQ(fault.has_value(), refused.has_value()) << how.post << ", round " << round;
      if (!fault) continue;
      ++found;
      EXPECT_EQ(fault->kind, Kind::Machine);
      EXPECT_EQ(fault->row, 1000 + static_cast<std::int64_t>(refused->row()));
      EXPECT_EQ(fault->last_row, fault->row);
      EXPECT_EQ(fault->tool, program.tool()[refused->row()]);
      EXPECT_EQ(fault->message, refused->reason());
      EXPECT_EQ(fault->point, program.poses()[refused->row()].tip);
    }
  }
  EXPECT_GT(found, 100);
}

TEST(MachineCheck, ChecksTheProgramInTheMachinesFrame) {
  nc::Program p;
  for (int k = 0; k < 3; ++k) p.append({{{10.0 * k, 0, 0}, {0, 1, 0}}, k ? 500.0 : 0.0, 9000, 1, 0, k == 0});
  MachineChoice machine{"3-axis", {}};
  EXPECT_TRUE(machine_fault(p, 0, machine).has_value()) << "the tool lies on its side";
  machine.turn = Mat3(1, 0, 0, 0, 0, 1, 0, -1, 0);  // y → z
  EXPECT_FALSE(machine_fault(p, 0, machine).has_value());
  machine.shift = Vec3(0, 0, 2 * nc::kMaxLength);
  const auto far = machine_fault(p, 0, machine);
  ASSERT_TRUE(far.has_value());
  EXPECT_EQ(far->message, "Z is out of range");
  EXPECT_EQ(far->point, p.poses()[0].tip) << "in the frame of the stock";
}

}  // namespace
}  // namespace riffler::verify::machine_check_test
