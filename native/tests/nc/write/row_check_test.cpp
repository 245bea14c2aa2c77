// What a machine cannot run: the check that writes nothing agrees with the writer, on random rows on every machine.
#include "nc/write/row_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <ostream>

#include "riffler/nc/write/writer.hpp"
#include "support/effort.hpp"
#include "support/random_rows.hpp"

namespace riffler::nc::row_check_test {
namespace {

using test::on_machine;
using test::tilted;

/// The error for a program: empty, or argument, row and reason.
struct Said {
  std::string name;
  std::size_t row = 0;
  std::string reason;

  bool operator==(const Said&) const = default;
};

std::ostream& operator<<(std::ostream& out, const Said& said) {
  return out << "[" << said.name << ", row " << said.row << ": " << said.reason << "]";
}

Said said(const std::optional<RowError>& fault) {
  return fault ? Said{fault->name(), fault->row(), fault->reason()} : Said{};
}

Said said_by_writer(const Program& program, const WriteOptions& how) {
  try {
    to_nc(program, how);
    return {};
  } catch (const RowError& e) {
    return {e.name(), e.row(), e.reason()};
  }
}

TEST(RowCheck, FindsExactlyTheRowsThatTheWriterRefuses) {
  const std::vector<WriteOptions> machines = test::all_machines();
  std::map<std::string, int> faults;
  int accepted = 0, refused = 0;
  test::RandomRows rows(17);
  constexpr int kRounds = 120;
  for (int round = 0; round < test::cases(kRounds); ++round) {
    const Program program = rows.program();
    for (const WriteOptions& how : machines) {
      const Said by_check = said(RowCheck(how).first_fault(program)), by_writer = said_by_writer(program, how);
      ASSERT_EQ(by_check, by_writer) << how.post << ", round " << round;
      ++(by_check == Said() ? accepted : refused);
      for (const char* sentence : {"no feed", "cannot hold it within", "out of range", "is opposite", "no rotary axes",
                                   "must be above every feed move"})
        faults[sentence] += by_check.reason.find(sentence) != std::string::npos;
    }
  }
  EXPECT_GT(accepted, 200);
  EXPECT_GT(refused, 200);
  if (test::cases(kRounds) < kRounds) return;  // the rarest faults are not among so few
  for (const auto& [sentence, count] : faults) EXPECT_GT(count, 0) << sentence;
}

/// Not what the writer says, but what must be: three axes hold upright tools only.
TEST(RowCheck, OfThreeAxesNamesTheFirstRowThatLeans) {
  test::RandomRows rows(5);
  int leaning = 0;
  for (int round = 0; round < 200; ++round) {
    const Program program = rows.program();
    const auto upright = [&](const Pose& pose) {
      return std::hypot(pose.axis.x, pose.axis.y) < 1e-6 && pose.axis.z > 0;
    };
    const auto first = std::ranges::find_if_not(program.poses(), upright);
    const auto fault = RowCheck(on_machine("3-axis")).first_fault(program);
    if (!program.via().empty() || (fault && fault->name() == "feed")) continue;
    if (first == program.poses().end()) continue;
    ++leaning;
    ASSERT_TRUE(fault.has_value());
    EXPECT_EQ(fault->row(), static_cast<std::size_t>(first - program.poses().begin()));
  }
  EXPECT_GT(leaning, 50);
}

/// The table swings the tip from 38 mm over 50 mm to 38 mm along X.
TEST(RowCheck, ChecksTheMotionBetweenRowsToo) {
  Program p;
  for (const double around : {50.0, 130.0}) p.append({{{50, 0, 0}, tilted(10, around)}, 500, 9000, 1});
  const auto fault = [&](double limit) {
    const Options options{{"rot_point", std::vector<double>{0, 0, 0}},
                          {"limits_x", std::vector<double>{-limit, limit}}};
    return RowCheck(on_machine("linuxcnc-xyzac", options)).first_fault(p);
  };
  EXPECT_FALSE(fault(51).has_value());
  ASSERT_TRUE(fault(45).has_value());
  EXPECT_EQ(fault(45)->row(), 1U);
  EXPECT_TRUE(fault(45)->reason().starts_with(
      "on the move there machine linuxcnc-xyzac would leave the limits of X, -45 to 45: "))
      << fault(45)->reason();
}

class Recorded final : public BlockSink {
 public:
  void change_tool(int number, const Tool*, bool) override { events.push_back("T" + std::to_string(number)); }
  void spindle(double) override { events.emplace_back("S"); }
  void ready(int) override { events.emplace_back("ready"); }
  void block(const PostBlock& block) override { events.emplace_back(block.must ? "row" : "block"); }
  void arc(const PostArc&) override { events.emplace_back("arc"); }
  std::vector<std::string> events;
};

TEST(RowCheck, PassesOnTheBlocksBeforeTheFault) {
  Program p;
  for (int k = 0; k < 4; ++k)
    p.append({{{10.0 * k, 0, 0}, tilted(k < 3 ? 0 : 10, 0)}, k ? 500.0 : 0.0, 9000, 1, 0, k == 0});
  Recorded sink;
  WriteReport report;
  const RowCheck leaning(on_machine("tcp", {{"limits_a", std::vector<double>{-5, 5}}}));
  const auto fault = leaning.first_fault(p, sink, report);
  ASSERT_TRUE(fault.has_value());
  EXPECT_EQ(fault->row(), 3U);
  Recorded all;
  EXPECT_FALSE(RowCheck(on_machine("tcp")).first_fault(p, all, report).has_value());
  EXPECT_EQ(std::vector(all.events.begin(), all.events.begin() + 4),
            (std::vector<std::string>{"T1", "S", "ready", "row"}));
  EXPECT_EQ(std::ranges::count(all.events, "row"), 4);
  EXPECT_EQ(report.blocks, 0U) << "counted by the post";
}

TEST(RowCheck, CanBeRepeatedAndTakesAnEmptyProgram) {
  const RowCheck check(on_machine("tcp", {{"limits_a", std::vector<double>{-5, 5}}}));
  EXPECT_FALSE(check.first_fault(Program()).has_value());
  Program p;
  p.append({{{0, 0, 0}, tilted(20, 0)}, 0, 0, 1, 0, true});
  const auto once = check.first_fault(p), twice = check.first_fault(p);
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(said(once), said(twice));
}

TEST(RowCheck, RefusesMachinesOptionsAndTolerancesAsTheWriterDoes) {
  WriteOptions coarse, fine;
  coarse.tolerance = 1e-6, fine.axis_tolerance = 1e-9;
  for (const WriteOptions& how :
       {on_machine("lathe"), on_machine("tcp", {{"speed", 3.0}}), on_machine("heidenhain", {{"tcp", false}}),
        on_machine("heidenhain", {{"retract", 0.0}}), on_machine("sinumerik", {{"tcp", false}}), coarse, fine}) {
    std::string by_check, by_writer;
    try {
      const RowCheck check(how);
    } catch (const std::invalid_argument& e) {
      by_check = e.what();
    }
    try {
      to_nc(Program(), how);
    } catch (const std::invalid_argument& e) {
      by_writer = e.what();
    }
    EXPECT_FALSE(by_check.empty());
    EXPECT_EQ(by_check, by_writer);
  }
}

}  // namespace
}  // namespace riffler::nc::row_check_test
